#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
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
  if (information_.empty()) return run;
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

namespace {

/// Steps of expectation maximisation from a rough start, and from the covariance of the null model.
constexpr int kFirstSteps = 60, kFurtherSteps = 4;

/// Draws errors of unit variance for each row, and errors of runs with the given covariance.
Eigen::VectorXd drawn(const std::vector<SharedFactor>& factor, const std::vector<int>& unit,
                      const RunError& run, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Eigen::SelfAdjointEigenSolver<RunError> eigen(run);
  const RunError root = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  std::map<int, SharedVector> of_unit;
  Eigen::VectorXd out(static_cast<Eigen::Index>(factor.size()) * kChannels);
  for (std::size_t row = 0; row < factor.size(); ++row) {
    Eigen::Vector4d error = Eigen::Vector4d::Zero();
    if (!unit.empty()) {
      const auto [at, fresh] = of_unit.try_emplace(unit[row]);
      if (fresh)
        for (double& v : at->second) v = normal(random);
      error = factor[row] * root * at->second;
    }
    for (int c = 0; c < kChannels; ++c)
      if (factor[row](c, c) != 0.0) error[c] += normal(random);
    out.segment<kChannels>(static_cast<Eigen::Index>(row) * kChannels) = error;
  }
  return out;
}

/// Draws the effect of another soil from its prior.
Eigen::VectorXd drawnSoil(const NullModel& null, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Eigen::VectorXd step(null.soil);
  for (Eigen::Index k = 0; k < step.size(); ++k)
    step[k] = null.known.prior.mean[k] + normal(random) / std::sqrt(null.known.prior.precision[k]);
  return null.known.columns.leftCols(null.soil) * step;  // (T36)
}

/// Scores of contenders relative to the null model, for each table.
class Contest {
 public:
  Contest(const RunLikelihood& likelihood, const RunSums& known, const RunError& run)
      : likelihood_(likelihood), known_(known), run_(run) {}

  void setTables(Eigen::Index tables) { at_run_ = likelihood_.heldOut(known_, run_, 0, tables).score(); }

  /// Gains on all tables with the run error of the null model.
  Eigen::VectorXd roughGains(const RunSums& both, const Contender& c) const {
    const HeldOutFit fit = likelihood_.heldOut(both, run_, 0, at_run_.size());
    Eigen::VectorXd gain = fit.score() - at_run_;
    for (Eigen::Index t = 0; t < gain.size(); ++t)
      if (!allowed(fit.steps, t, c.positive)) gain[t] = 0.0;
    return gain.array() + c.log_prior;
  }

  double nullScore(Eigen::Index table) const {
    const RunError run = likelihood_.profile(known_, run_, table, kFurtherSteps);
    return likelihood_.heldOut(known_, run, table, 1).score()[0];
  }

  double profiledGain(const RunSums& both, const Contender& c, Eigen::Index table, double null_score) const {
    const RunError run = likelihood_.profile(both, run_, table, kFurtherSteps);
    const HeldOutFit fit = likelihood_.heldOut(both, run, table, 1);
    return (allowed(fit.steps, 0, c.positive) ? fit.score()[0] - null_score : 0.0) + c.log_prior;  // (T35)
  }

 private:
  bool allowed(const Eigen::MatrixXd& steps, Eigen::Index table, bool positive) const {
    return !positive || steps(known_.prior.mean.size(), table) > 0.0;
  }

  const RunLikelihood& likelihood_;
  const RunSums& known_;
  RunError run_;
  Eigen::VectorXd at_run_;
};

/// Returns the greatest profiled gain on one table, among the kProfiled contenders with the greatest gains at
/// the run error of the null model.
double greatestGain(const Contest& contest, const std::vector<RunSums>& sums,
                    const std::vector<Contender>& contenders, const Eigen::MatrixXd& rough,
                    Eigen::Index table) {
  std::vector<Eigen::Index> order(sums.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const auto most = std::min<std::size_t>(order.size(), kProfiled);
  std::partial_sort(order.begin(), order.begin() + static_cast<long>(most), order.end(),
                    [&](Eigen::Index a, Eigen::Index b) { return rough(table, a) > rough(table, b); });
  const double null_score = contest.nullScore(table);
  double greatest = 0.0;
  for (std::size_t k = 0; k < most; ++k) {
    const auto c = static_cast<std::size_t>(order[k]);
    greatest = std::max(greatest, contest.profiledGain(sums[c], contenders[c], table, null_score));  // (T37)
  }
  return greatest;
}

}  // namespace

double GainDistribution::threshold(double level) const {
  if (greatest.empty()) return 0.0;
  const auto above = static_cast<std::size_t>(level * static_cast<double>(greatest.size() + 1));
  // (T38)
  return greatest[greatest.size() - std::clamp<std::size_t>(above, 1, greatest.size())] + further_questions;
}

double GainDistribution::pValue(double reached) const {
  const auto below =
      std::lower_bound(greatest.begin(), greatest.end(), reached - further_questions) - greatest.begin();
  const auto beyond = static_cast<double>(greatest.size()) - static_cast<double>(below);
  return (beyond + 1.0) / (static_cast<double>(greatest.size()) + 1.0);  // (T39)
}

GainDistribution gainDistribution(const NullModel& null, const Contenders& contenders, int draws,
                                  std::uint64_t seed, const std::function<bool(double)>& go_on) {
  RunLikelihood likelihood(null.factor, null.unit, null.folds);
  GainDistribution out;
  likelihood.setTables(null.residual);
  out.run = likelihood.profile(likelihood.sums(null.known), null.run_start, 0, kFirstSteps);
  Eigen::MatrixXd tables(null.residual.size(), 1 + draws);
  tables.col(0) = null.residual;
  std::mt19937_64 random(seed);
  for (int k = 1; k <= draws; ++k)
    tables.col(k) = drawn(null.factor, null.unit, out.run, random) + drawnSoil(null, random);
  likelihood.setTables(tables);
  const RunSums of_known = likelihood.sums(null.known);
  Contest contest(likelihood, of_known, out.run);
  contest.setTables(tables.cols());
  out.null_score = contest.nullScore(0);
  out.gain.assign(contenders.count, 0.0);
  std::vector<RunSums> sums;
  std::vector<Contender> each;
  Eigen::MatrixXd rough(tables.cols(), static_cast<Eigen::Index>(contenders.count));
  for (std::size_t k = 0; k < contenders.count; ++k) {
    if (!go_on(0.8 * static_cast<double>(k) / static_cast<double>(contenders.count))) return out;
    each.push_back(contenders.at(k));
    sums.push_back(likelihood.sums(of_known, null.known, each[k].added));
    each[k].added = {};
    rough.col(static_cast<Eigen::Index>(k)) = contest.roughGains(sums[k], each[k]);
    out.gain[k] = contest.profiledGain(sums[k], each[k], 0, out.null_score);
  }
  for (int draw = 1; draw <= draws && go_on(0.8 + 0.2 * draw / draws); ++draw)
    out.greatest.push_back(greatestGain(contest, sums, each, rough, draw));
  std::sort(out.greatest.begin(), out.greatest.end());
  return out;
}

RunError runErrorOf(const NullModel& null) {
  RunLikelihood likelihood(null.factor, null.unit, null.folds);
  likelihood.setTables(null.residual);
  return likelihood.profile(likelihood.sums(null.known), null.run_start, 0, kFirstSteps);
}

double fittedScore(const NullModel& fitted) {
  RunLikelihood likelihood(fitted.factor, fitted.unit, fitted.folds);
  likelihood.setTables(fitted.residual);
  const RunSums sums = likelihood.sums(fitted.known);
  const RunError run = likelihood.profile(sums, fitted.run_start, 0, 2 * kFurtherSteps);
  return likelihood.heldOut(sums, run, 0, 1).score()[0];
}

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

namespace {

constexpr int kFolds = 5;

/// Assigns rows to bands of similar values; neighbouring bands are in different folds.
std::vector<int> bands(const std::vector<double>& value, int count) {
  std::vector<std::size_t> order(value.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return value[a] < value[b]; });
  std::vector<int> fold(value.size());
  for (std::size_t k = 0; k < order.size(); ++k)
    fold[order[k]] = static_cast<int>(k * static_cast<std::size_t>(count) / order.size()) % kFolds;
  return fold;
}

/// Level number of each row of a column, in ascending order; values within `width` are one level.
std::vector<int> levels(const std::vector<double>& value, double width) {
  std::map<long, int> number;
  for (double v : value) number.try_emplace(std::lround(v / width), 0);
  int next = 0;
  for (auto& [key, level] : number) level = next++;
  std::vector<int> level;
  for (double v : value) level.push_back(number[std::lround(v / width)]);
  return level;
}

}  // namespace

Folds foldsOf(const Trial& trial) {
  const std::set<int> runs(trial.run.begin(), trial.run.end());
  if (runs.size() >= kFolds && 2 * runs.size() <= trial.run.size()) {
    // Consecutive moments of a drive have similar errors; whole stretches of the drive are therefore held
    // out.
    const bool moments = trial.run == trial.moment;
    const auto of = [&](int run) {
      const auto k = std::distance(runs.begin(), runs.find(run)),
                 count = static_cast<std::ptrdiff_t>(runs.size());
      return static_cast<int>((moments ? 2 * kFolds * k / count : k) % kFolds);
    };
    std::vector<int> fold;
    for (int run : trial.run) fold.push_back(of(run));
    return {moments ? "stretches of the drive, ten in five folds" : "whole runs, five folds", fold, kFolds};
  }
  std::vector<int> level = levels(trial.slip, 0.02);
  const auto count = static_cast<std::size_t>(*std::max_element(level.begin(), level.end())) + 1;
  if (count >= kFolds && 4 * count <= level.size() && count <= 20) {
    for (int& l : level) l %= kFolds;
    return {"whole slip levels, five folds", level, kFolds};
  }
  if (count >= kFolds) return {"whole bands of slip, ten bands in five folds", bands(trial.slip, 10), kFolds};
  return {"whole bands of load, ten bands in five folds", bands(trial.load_N, 10), kFolds};
}

Folds levelFolds(const Trial& trial, const std::string& column) {
  std::vector<double> value;
  for (const WheelState& s : trial.states) value.push_back(std::abs(s.covariate(column)));
  if (value.empty() || std::any_of(value.begin(), value.end(), [](double v) { return !std::isfinite(v); }))
    return {};
  const auto [low, high] = std::minmax_element(value.begin(), value.end());
  if (*high <= *low) return {};
  const std::vector<int> level = levels(value, 0.04 * (*high - *low));
  const int count = *std::max_element(level.begin(), level.end()) + 1;
  if (count < 3) return {};
  if (count > 8) return {"whole bands of " + column + ", ten bands in five folds", bands(value, 10), kFolds};
  return {"whole levels of " + column + ", each held out in turn", level, count};
}

std::vector<char> rowsOf(const Folds& folds, int fold, bool held) {
  std::vector<char> rows;
  for (int f : folds.of_row) rows.push_back((f == fold) == held);
  return rows;
}

}  // namespace talus::terramech
