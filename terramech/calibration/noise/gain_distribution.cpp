#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include <Eigen/Eigenvalues>

#include <talus/terramech/calibration/noise/gain_distribution.hpp>

namespace talus::terramech {
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

}  // namespace talus::terramech
