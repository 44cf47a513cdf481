#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <talus/terramech/trace/run_likelihood.hpp>
#include <talus/terramech/trace/run_units.hpp>

namespace talus::terramech {
namespace {

/// Twenty times more likely: log 20.
constexpr double kClearly = 3.0;

/// Runs from 0 on; empty where rows have none, one for all when there is one.
std::vector<int> runsOf(const Trial& trial) {
  std::map<int, int> number;
  std::vector<int> run;
  for (int r : trial.run) run.push_back(number.try_emplace(r, static_cast<int>(number.size())).first->second);
  if (2 * number.size() > trial.run.size()) run.assign(run.size(), 0);
  return run;
}

/// Each run cut into stretches of some rows in the order of time.
std::vector<int> stretches(const Trial& trial, const std::vector<int>& run, int length) {
  std::vector<std::size_t> order(run.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto time = [&](std::size_t row) { return trial.states[row].time_s; };
  if (std::all_of(order.begin(), order.end(), [&](std::size_t row) { return std::isfinite(time(row)); }))
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return time(a) < time(b); });
  std::map<int, int> seen;
  std::map<std::pair<int, int>, int> number;
  std::vector<int> unit(run.size());
  for (std::size_t row : order) {
    const int at = seen[run[row]]++ / length;
    unit[row] = number.try_emplace({run[row], at}, static_cast<int>(number.size())).first->second;
  }
  return unit;
}

double logLikelihood(const Whitening& whitening, const std::vector<int>& unit, const Eigen::VectorXd& table) {
  const auto rows = whitening.factor.size();
  RunLikelihood likelihood(whitening.factor, unit, {"", std::vector<int>(rows, 0), 1});
  likelihood.setTables(table);
  if (unit.empty()) return likelihood.logLikelihood(Eigen::Matrix4d::Zero(), 0);
  const LinearModel none{Eigen::MatrixXd::Zero(table.size(), 1),
                         {Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)}};
  const Eigen::Matrix4d run = likelihood.profile(likelihood.sums(none), roughRunError(whitening), 0, 30);
  return likelihood.logLikelihood(run, 0);
}

}  // namespace

Eigen::Matrix4d roughRunError(const Whitening& whitening) {
  return whitening.std.cwiseAbs2().colwise().mean().transpose().asDiagonal();
}

std::vector<int> runUnits(const Trial& trial, const Whitening& whitening, const Eigen::MatrixXd& left) {
  if (!trial.moment.empty()) return {};
  const Eigen::VectorXd table = whitening.rowByRow(left);
  const std::vector<int> run = runsOf(trial);
  std::vector<int> best = *std::max_element(run.begin(), run.end()) > 0 ? run : std::vector<int>{};
  double likely = logLikelihood(whitening, best, table);
  for (int length : {16, 8, 4}) {
    if (3 * length > trial.rows()) continue;
    const std::vector<int> cut = stretches(trial, run, length);
    const double now = logLikelihood(whitening, cut, table);
    if (now < likely + kClearly) continue;
    best = cut;
    likely = now;
  }
  return best;
}

Eigen::MatrixXd unitMeans(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& std,
                          const std::vector<int>& unit) {
  const int units = *std::max_element(unit.begin(), unit.end()) + 1;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(units, residual.cols()), weight = sum, mean = residual;
  for (Eigen::Index row = 0; row < residual.rows(); ++row)
    for (Eigen::Index c = 0; c < residual.cols(); ++c) {
      if (!std::isfinite(residual(row, c))) continue;
      const double w = 1.0 / (std(row, c) * std(row, c));
      sum(unit[static_cast<std::size_t>(row)], c) += w * residual(row, c);
      weight(unit[static_cast<std::size_t>(row)], c) += w;
    }
  for (Eigen::Index row = 0; row < residual.rows(); ++row)
    for (Eigen::Index c = 0; c < residual.cols(); ++c) {
      const int u = unit[static_cast<std::size_t>(row)];
      mean(row, c) = std::isfinite(residual(row, c)) && weight(u, c) > 0.0 ? sum(u, c) / weight(u, c) : 0.0;
    }
  return mean;
}

}  // namespace talus::terramech
