#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <talus/terramech/calibration/noise/run_likelihood.hpp>

namespace talus::terramech {

/// Sums of one fold with the covariance of a run's error.
struct RunLikelihood::FoldSums {
  Eigen::MatrixXd gram, cross;
  Eigen::VectorXd square;
  double log_determinant = 0.0;
};

namespace {

/// Rows of a matrix that belong to one row of the table (kChannels), and to one unit (kShared).
template <typename Matrix>
auto channelsOf(Matrix&& all, std::size_t row) {
  return all.template middleRows<kChannels>(static_cast<Eigen::Index>(row) * kChannels);
}
template <typename Matrix>
auto rowsOf(Matrix&& all, std::size_t unit) {
  return all.template middleRows<kShared>(static_cast<Eigen::Index>(unit) * kShared);
}

/// Sum of F^T X over the rows of each unit, stacked.
Eigen::MatrixXd unitSums(const std::vector<SharedFactor>& factor, const std::vector<int>& unit,
                         std::size_t units, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(units) * kShared, columns.cols());
  for (std::size_t row = 0; row < unit.size(); ++row)
    rowsOf(sum, static_cast<std::size_t>(unit[row])).noalias() +=
        factor[row].transpose() * channelsOf(columns, row);
  return sum;
}

/// The rows of a matrix, split by fold.
std::vector<Eigen::MatrixXd> byFold(const Eigen::MatrixXd& columns, const std::vector<int>& fold, int folds) {
  std::vector<Eigen::MatrixXd> part;
  for (int f = 0; f < folds; ++f) {
    const auto rows = std::count(fold.begin(), fold.end(), f);
    Eigen::MatrixXd& own = part.emplace_back(rows * kChannels, columns.cols());
    Eigen::Index to = 0;
    for (std::size_t row = 0; row < fold.size(); ++row)
      if (fold[row] == f)
        own.middleRows<kChannels>(kChannels * to++) =
            columns.middleRows<kChannels>(static_cast<Eigen::Index>(row) * kChannels);
  }
  return part;
}

StepPrior joined(const StepPrior& a, const StepPrior& b) {
  StepPrior both{Eigen::VectorXd(a.mean.size() + b.mean.size()), {}};
  both.precision.resize(both.mean.size());
  both.mean << a.mean, b.mean;
  both.precision << a.precision, b.precision;
  return both;
}

/// Removes the correlations of strength and stiffness with each other and with the offsets.
RunError withoutCoupling(const RunError& run) {
  RunError r = RunError(run.diagonal().asDiagonal());
  r.topLeftCorner<kChannels, kChannels>() = run.topLeftCorner<kChannels, kChannels>();
  return r;
}

/// Precision about 0 that is added to every step: standard deviation of 30 000 steps. Only a direction that
/// neither a prior nor a row determines is affected.
constexpr double kLeastPrecision = 1e-9;

/// Normal equations of the steps, including the prior: A step = b (T31).
struct Normal {
  Normal(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& cross, const StepPrior& prior)
      : precision(gram), right(cross) {
    precision.diagonal() += prior.precision;
    precision.diagonal().array() += kLeastPrecision;
    right.colwise() += prior.precision.cwiseProduct(prior.mean);
    solver.compute(precision);
  }
  Eigen::MatrixXd steps() const { return solver.solve(right); }

  /// Minimum of step^T A step - 2 b^T step for each table, evaluated at `steps`; rounding errors of `steps`
  /// have an effect of second order only.
  Eigen::VectorXd leastAt(const Eigen::MatrixXd& steps) const {
    return steps.cwiseProduct(precision * steps - 2.0 * right).colwise().sum().transpose();
  }
  double logDeterminant() const { return solver.vectorD().array().max(kLeastPrecision).log().sum(); }

  Eigen::MatrixXd precision, right;
  Eigen::LDLT<Eigen::MatrixXd> solver;
};

/// Squared departures of each table's steps from the prior, in units of its standard deviations.
Eigen::MatrixXd squaresOf(const StepPrior& prior, const Eigen::MatrixXd& steps) {
  return prior.precision.asDiagonal() * (steps.colwise() - prior.mean).cwiseAbs2();
}

}  // namespace

RunLikelihood::RunLikelihood(const std::vector<SharedFactor>& factor, const std::vector<int>& unit,
                             const Folds& folds)
    : factor_(factor), fold_(folds.of_row), folds_(folds.count) {
  std::map<std::pair<int, int>, int> number;
  for (std::size_t row = 0; row < unit.size(); ++row) {
    const auto [at, fresh] = number.try_emplace({unit[row], fold_[row]}, static_cast<int>(number.size()));
    unit_.push_back(at->second);
    if (!fresh) continue;
    fold_of_unit_.push_back(fold_[row]);
    information_.emplace_back(RunError::Zero());
  }
  for (std::size_t row = 0; row < unit_.size(); ++row)
    information_[static_cast<std::size_t>(unit_[row])] += factor_[row].transpose() * factor_[row];
}

void RunLikelihood::setTables(const Eigen::MatrixXd& tables) {
  tables_ = byFold(tables, fold_, folds_);
  square_ = Eigen::MatrixXd::Zero(folds_, tables.cols());
  for (std::size_t row = 0; row < fold_.size(); ++row)
    square_.row(fold_[row]) +=
        tables.middleRows<kChannels>(static_cast<Eigen::Index>(row) * kChannels).colwise().squaredNorm();
  unit_table_ = unitSums(factor_, unit_, information_.size(), tables);
}

RunSums RunLikelihood::sums(const LinearModel& model) const {
  RunSums s;
  s.prior = model.prior;
  const auto x = byFold(model.columns, fold_, folds_);
  for (std::size_t f = 0; f < x.size(); ++f) {
    s.gram.emplace_back(x[f].transpose() * x[f]);
    s.cross.emplace_back(x[f].transpose() * tables_[f]);
  }
  s.unit_column = unitSums(factor_, unit_, information_.size(), model.columns);
  return s;
}

RunSums RunLikelihood::sums(const RunSums& of_known, const LinearModel& known,
                            const LinearModel& added) const {
  RunSums s = sums(added);
  const Eigen::Index p = known.columns.cols(), q = added.columns.cols();
  const auto a = byFold(known.columns, fold_, folds_), b = byFold(added.columns, fold_, folds_);
  for (std::size_t f = 0; f < a.size(); ++f) {
    Eigen::MatrixXd gram(p + q, p + q), cross(p + q, square_.cols());
    gram.topLeftCorner(p, p) = of_known.gram[f];
    gram.topRightCorner(p, q) = a[f].transpose() * b[f];
    gram.bottomLeftCorner(q, p) = gram.topRightCorner(p, q).transpose();
    gram.bottomRightCorner(q, q) = s.gram[f];
    cross << of_known.cross[f], s.cross[f];
    s.gram[f] = std::move(gram);
    s.cross[f] = std::move(cross);
  }
  Eigen::MatrixXd columns(s.unit_column.rows(), p + q);
  columns << of_known.unit_column, s.unit_column;
  s.unit_column = std::move(columns);
  s.prior = joined(known.prior, added.prior);
  return s;
}

/// K = (R^-1 + C)^-1 = R (1 + C R)^-1: covariance of a unit's error given its rows (Woodbury).
RunError RunLikelihood::shrink(std::size_t unit, const RunError& run) const {
  const RunError k = run * (RunError::Identity() + information_[unit] * run).inverse();  // (T17)
  return 0.5 * (k + k.transpose());
}

RunLikelihood::FoldSums RunLikelihood::together(const std::vector<FoldSums>& fold) {
  FoldSums all{Eigen::MatrixXd::Zero(fold.front().gram.rows(), fold.front().gram.cols()),
               Eigen::MatrixXd::Zero(fold.front().cross.rows(), fold.front().cross.cols()),
               {}};
  for (const FoldSums& f : fold) {
    all.gram += f.gram;
    all.cross += f.cross;
  }
  return all;
}

std::vector<RunLikelihood::FoldSums> RunLikelihood::underRun(const RunSums& sums, const RunError& run,
                                                             Eigen::Index first, Eigen::Index count) const {
  std::vector<FoldSums> fold;
  for (std::size_t f = 0; f < sums.gram.size(); ++f)
    fold.push_back({sums.gram[f], sums.cross[f].middleCols(first, count),
                    square_.row(static_cast<Eigen::Index>(f)).segment(first, count).transpose()});
  for (std::size_t u = 0; u < information_.size(); ++u) {
    FoldSums& own = fold[static_cast<std::size_t>(fold_of_unit_[u])];  // (T18)
    const RunError k = shrink(u, run);
    const auto x = rowsOf(sums.unit_column, u);
    const Eigen::MatrixXd kx = k * x;
    const auto y = rowsOf(unit_table_, u).middleCols(first, count);
    own.gram.noalias() -= x.transpose() * kx;
    own.cross.noalias() -= kx.transpose() * y;
    own.square -= y.cwiseProduct(k * y).colwise().sum().transpose();
    own.log_determinant += std::log((RunError::Identity() + information_[u] * run).determinant());
  }
  return fold;
}

HeldOutFit RunLikelihood::heldOut(const RunSums& sums, const RunError& run, Eigen::Index first,
                                  Eigen::Index count) const {
  const std::vector<FoldSums> fold = underRun(sums, run, first, count);
  const FoldSums all = together(fold);
  const Normal whole(all.gram, all.cross, sums.prior);
  HeldOutFit fit{Eigen::VectorXd::Zero(count), {}, whole.steps()};
  const Eigen::VectorXd least = whole.leastAt(fit.steps);
  Eigen::MatrixXd of_prior = squaresOf(sums.prior, fit.steps);
  for (const FoldSums& f : fold) {
    const Normal others(all.gram - f.gram, all.cross - f.cross, sums.prior);
    const Eigen::MatrixXd steps = others.steps();
    const Eigen::VectorXd chi2 = f.square + least - others.leastAt(steps);  // (T32)
    const double log_determinant = f.log_determinant + whole.logDeterminant() - others.logDeterminant();
    fit.log_likelihood.array() -= 0.5 * (chi2.array() + log_determinant);
    of_prior = of_prior.cwiseMin(squaresOf(sums.prior, steps));  // (T33)
  }
  fit.prior_chi2 = of_prior.colwise().sum().transpose();
  return fit;
}

RunError RunLikelihood::profile(const RunSums& sums, RunError run, Eigen::Index table, int steps) const {
  if (!hasUnits()) return run;
  const auto units = information_.size();
  Eigen::MatrixXd of_rows = sums.gram.front();
  Eigen::VectorXd of_table = sums.cross.front().col(table);
  for (std::size_t f = 1; f < sums.gram.size(); ++f) {
    of_rows += sums.gram[f];
    of_table += sums.cross[f].col(table);
  }
  const Eigen::VectorXd y = unit_table_.col(table);
  Eigen::MatrixXd kx(sums.unit_column.rows(), sums.unit_column.cols());
  std::vector<RunError> k(units);
  for (int step = 0; step < steps; ++step) {
    for (std::size_t u = 0; u < units; ++u) {
      k[u] = shrink(u, run);
      rowsOf(kx, u).noalias() = k[u] * rowsOf(sums.unit_column, u);
    }
    const Normal normal(of_rows - sums.unit_column.transpose() * kx, of_table - kx.transpose() * y,
                        sums.prior);
    const Eigen::VectorXd at = normal.steps(), shared = kx * at;
    const Eigen::MatrixXd spread = normal.solver.solve(kx.transpose());
    RunError next = RunError::Zero();
    for (std::size_t u = 0; u < units; ++u) {
      const SharedVector error = k[u] * rowsOf(y, u) - rowsOf(shared, u);
      const auto first = static_cast<Eigen::Index>(u) * kShared;
      next += error * error.transpose() + k[u] + rowsOf(kx, u) * spread.middleCols<kShared>(first);
    }
    run = withoutCoupling(next / static_cast<double>(units));  // (T19)
  }
  return run;
}

double RunLikelihood::logLikelihood(const RunError& run, Eigen::Index table) const {
  double chi2 = square_.col(table).sum();
  for (std::size_t u = 0; u < information_.size(); ++u) {
    const SharedVector y = rowsOf(unit_table_, u).col(table);
    chi2 +=
        std::log((RunError::Identity() + information_[u] * run).determinant()) - y.dot(shrink(u, run) * y);
  }
  return -0.5 * chi2;  // (T21)
}

}  // namespace talus::terramech
