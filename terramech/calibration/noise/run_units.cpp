#include <algorithm>
#include <cmath>
#include <map>

#include <talus/terramech/calibration/noise/run_likelihood.hpp>
#include <talus/terramech/calibration/noise/run_units.hpp>

namespace talus::terramech {
namespace {

/// Log-likelihood ratio of 20: ln 20 = 3.0.
constexpr double kClearly = 3.0;

/// Run numbers from 0; all 0 if rows have no run labels.
std::vector<int> runsOf(const Trial& trial) {
  std::map<int, int> number;
  std::vector<int> run;
  for (int r : trial.run) run.push_back(number.try_emplace(r, static_cast<int>(number.size())).first->second);
  if (2 * number.size() > trial.run.size()) run.assign(run.size(), 0);
  return run;
}

/// Rows of each run in order of time; empty if a time is missing.
std::vector<std::vector<std::size_t>> inTime(const Trial& trial, const std::vector<int>& run) {
  std::map<int, std::vector<std::size_t>> rows;
  for (std::size_t row = 0; row < run.size(); ++row) {
    if (!std::isfinite(trial.states[row].time_s)) return {};
    rows[run[row]].push_back(row);
  }
  std::vector<std::vector<std::size_t>> all;
  for (auto& [number, own] : rows) {
    std::stable_sort(own.begin(), own.end(), [&](std::size_t a, std::size_t b) {
      return trial.states[a].time_s < trial.states[b].time_s;
    });
    all.push_back(std::move(own));
  }
  return all;
}

/// True if a column that determines the contact depends on time within the runs (correlation of neighbours
/// above 0.3, with which a tenth of a missing effect would appear as shared error): the error of the model
/// then persists like noise.
bool isInOrder(const Trial& trial, const std::vector<std::vector<std::size_t>>& runs) {
  for (const char* name : {"slip", "load_N", "slip_angle_rad", "slope_rad", "speed_mps", "pass_index"}) {
    if (std::find(trial.covariates.begin(), trial.covariates.end(), name) == trial.covariates.end()) continue;
    double product = 0.0, square = 0.0;
    for (const auto& rows : runs) {
      double mean = 0.0;
      for (std::size_t row : rows)
        mean += trial.states[row].covariate(name) / static_cast<double>(rows.size());
      double last = 0.0;
      for (std::size_t row : rows) {
        const double x = trial.states[row].covariate(name) - mean;
        product += x * last;
        square += x * x;
        last = x;
      }
    }
    if (product > 0.3 * square) return true;  // false for NaN: a column without values
  }
  return false;
}

/// Divides each run into stretches of `length` rows.
std::vector<int> stretches(const std::vector<std::vector<std::size_t>>& runs, std::size_t rows,
                           std::size_t length) {
  std::vector<int> unit(rows);
  int number = -1;
  for (const auto& own : runs)
    for (std::size_t k = 0; k < own.size(); ++k) {
      if (k % length == 0) ++number;
      unit[own[k]] = number;
    }
  return unit;
}

double logLikelihood(const Whitening& whitening, const std::vector<int>& unit, const Eigen::VectorXd& table) {
  const auto rows = whitening.factor.size();
  RunLikelihood likelihood(whitening.shared(), unit, {"", std::vector<int>(rows, 0), 1});
  likelihood.setTables(table);
  if (unit.empty()) return likelihood.logLikelihood(RunError::Zero(), 0);
  const LinearModel none{Eigen::MatrixXd::Zero(table.size(), 1),
                         {Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)}};
  const RunError run = likelihood.profile(likelihood.sums(none), roughRunError(whitening), 0, 30);
  return likelihood.logLikelihood(run, 0);
}

}  // namespace

RunError roughRunError(const Whitening& whitening) {
  constexpr double kSoil = 0.1;
  SharedVector variance = SharedVector::Constant(kSoil * kSoil);
  variance.head<kChannels>() = whitening.std.cwiseAbs2().colwise().mean().transpose();
  if (whitening.common.by_soil.empty()) variance.tail<kShared - kChannels>().setZero();
  return variance.asDiagonal();
}

std::vector<int> runUnits(const Trial& trial, const Whitening& whitening, const Eigen::MatrixXd& left) {
  const Eigen::VectorXd table = whitening.rowByRow(left);
  const bool drive = !trial.moment.empty();
  // Rows of a drive belong to moments; a drive with too few runs counts as one run.
  const bool one_run = drive && trial.run == trial.moment;
  const std::vector<int> run = one_run ? std::vector<int>(trial.run.size(), 0) : runsOf(trial);
  const std::size_t together =
      drive ? std::max<std::size_t>(1, run.size() / (1 + static_cast<std::size_t>(*std::max_element(
                                                             trial.moment.begin(), trial.moment.end()))))
            : 1;
  std::vector<int> best = *std::max_element(run.begin(), run.end()) > 0 ? run : std::vector<int>{};
  double likely = logLikelihood(whitening, best, table);
  const auto runs = inTime(trial, run);
  // On a drive the slip follows the ground in order of time, and errors persist; stretches are therefore
  // always tested.
  if (runs.empty() || (!drive && isInOrder(trial, runs))) return best;
  for (const std::size_t length : std::initializer_list<std::size_t>{16, 8, 4}) {
    if (3 * length * together > run.size()) continue;
    const std::vector<int> cut = stretches(runs, run.size(), length * together);
    const double now = logLikelihood(whitening, cut, table);
    if (now < likely + kClearly) continue;  // (T21)
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
