#include "plain_scan.hpp"

#include <cmath>
#include <map>
#include <set>

#include <Eigen/Cholesky>

#include <talus/terramech/calibration/noise/run_likelihood.hpp>
#include <talus/terramech/calibration/noise/sensor_noise.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>

namespace talus::terramech {
namespace {

struct Choice {
  std::string column;
  double reduction = 0.05;
  int channel = -1;
  Eigen::VectorXd explained;
};

Eigen::VectorXd solved(const Eigen::MatrixXd& x, const Eigen::VectorXd& y) {
  Eigen::MatrixXd normal = x.transpose() * x;
  normal.diagonal().array() += 1e-6 * (1.0 + normal.trace());
  return normal.ldlt().solve(x.transpose() * y);
}

/// Squared error of each row, predicted from the other folds.
Eigen::VectorXd heldOut(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, const std::vector<int>& fold) {
  Eigen::VectorXd errors(y.size());
  for (const int f : std::set<int>(fold.begin(), fold.end())) {
    std::vector<Eigen::Index> in, out;
    for (std::size_t k = 0; k < fold.size(); ++k)
      (fold[k] == f ? out : in).push_back(static_cast<Eigen::Index>(k));
    const Eigen::VectorXd at = solved(x(in, Eigen::all), y(in));
    for (const Eigen::Index k : out) errors[k] = std::pow(y[k] - x.row(k).dot(at), 2);
  }
  return errors;
}

/// Candidate shapes: a line, a spline, and a mean of each level if the levels are few.
std::vector<Eigen::MatrixXd> shapes(const Eigen::VectorXd& x) {
  std::vector<Eigen::MatrixXd> all;
  for (const int most : {2, 4})
    if (const auto knots = quantileKnots(x, most); knots.size() > 1) all.push_back(splineBasis(x, knots));
  std::map<double, Eigen::Index> level;
  for (const double v : x) level.try_emplace(v, static_cast<Eigen::Index>(level.size()));
  if (level.size() < 2 || level.size() > 8) return all;
  all.push_back(Eigen::MatrixXd::Zero(x.size(), static_cast<Eigen::Index>(level.size())));
  for (Eigen::Index k = 0; k < x.size(); ++k) all.back()(k, level[x[k]]) = 1.0;
  return all;
}

bool isClear(const Eigen::VectorXd& less, const std::vector<int>& run) {
  std::map<int, double> of_run;
  for (std::size_t k = 0; k < run.size(); ++k) of_run[run[k]] += less[static_cast<Eigen::Index>(k)];
  double sum = 0.0, square = 0.0;
  for (const auto& [number, v] : of_run) sum += v, square += v * v;
  const auto n = static_cast<double>(of_run.size());
  return sum > 3.0 * std::sqrt(std::max(0.0, square - sum * sum / n));
}

void tryColumn(const Trial& trial, const Folds& folds, const Eigen::MatrixXd& residual,
               const std::string& column, int channel, Choice& best) {
  std::vector<int> rows, fold, run;
  const Eigen::VectorXd all = covariateValues(trial, column, {});
  for (int row = 0; row < trial.rows(); ++row) {
    if (!std::isfinite(residual(row, channel)) || !std::isfinite(all[row])) continue;
    rows.push_back(row);
    fold.push_back(folds.of_row[static_cast<std::size_t>(row)]);
    run.push_back(trial.run[static_cast<std::size_t>(row)]);
  }
  if (rows.size() < 12 || rows.size() < static_cast<std::size_t>(trial.rows())) return;
  const Eigen::VectorXd y = residual.col(channel);
  const Eigen::VectorXd constant = heldOut(Eigen::MatrixXd::Ones(y.size(), 1), y, fold);
  for (const Eigen::MatrixXd& x : shapes(all)) {
    const Eigen::VectorXd less = constant - heldOut(x, y, fold);
    const double reduction = less.sum() / constant.sum();
    if (reduction <= best.reduction || !isClear(less, run)) continue;
    best = {column, reduction, channel, x * solved(x, y)};
  }
}

}  // namespace

std::vector<std::string> plainScan(const RefinedModel& base, const Trial& trial, bool fit_soil) {
  const TraceResult fitted = traceResiduals(base, trial, {.max_effects = 0, .fit_soil = fit_soil});
  SolvedContacts solved;
  Eigen::MatrixXd residual = trial.measured - predictRows(fitted.base, trial, solved);
  const Folds folds = foldsOf(trial);
  std::vector<std::string> columns;
  while (columns.size() < 3) {
    Choice best;
    for (const std::string& column : trial.covariates)
      for (int c = 0; c < kChannels; ++c) tryColumn(trial, folds, residual, column, c, best);
    if (best.channel < 0) return columns;
    residual.col(best.channel) -= best.explained;
    columns.push_back(best.column);
  }
  return columns;
}

}  // namespace talus::terramech
