#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/held_out/held_out.hpp>
#include <talus/terramech/calibration/noise/run_likelihood.hpp>
#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {
namespace {

/// Whitening of the rows for one model, because the effect of the noise of slip and load depends on the
/// model.
Whitening whiteningOf(const RefinedModel& model, const SharedError& shared, const TraceResult& result) {
  SolvedContacts solved;
  Whitening all = whitening(result.trial, predictRows(model, result.trial, solved),
                            inputSlopes(model, result.trial, solved), model.noise);
  all.common = shared;
  return all;
}

RefinedModel refitted(const RefinedModel& model, const SharedError& shared, const TraceResult& result,
                      const TraceOptions& options, const std::vector<char>& train) {
  const Trial seen = subset(result.trial, train);
  const Whitening white = subset(whiteningOf(model, shared, result), train);
  SolvedContacts start;
  FitPlan plan = fitPlan(model, options.fit_soil);
  plan.iterations = 8;
  plan.misfit = misfitOf(white.apply(seen.measured - predictRows(model, seen, start)), seen);
  return fitModel(model, seen, white, plan, start).model;
}

}  // namespace

RefinedModel refittedBase(const TraceResult& result, const TraceOptions& options, std::vector<char> train) {
  const std::vector<char> of_soil = rowsOfSoil(subset(result.trial, train));
  for (std::size_t row = 0, seen = 0; row < train.size(); ++row)
    if (train[row] && !of_soil[seen++]) train[row] = 0;
  return refitted(result.base, result.base_shared, result, options, train);
}

RefinedModel refittedModel(const TraceResult& result, const TraceOptions& options,
                           const std::vector<char>& train) {
  return refitted(result.refined, result.shared, result, options, train);
}

namespace {

/// Writes the predictions of a model for the rows marked by `held` into their rows of `all`. A reading that
/// these rows alone do not determine, as the pull of a moment without some of its wheels, has none.
void predictHeld(const RefinedModel& model, const Trial& trial, const std::vector<char>& held,
                 Eigen::MatrixXd& all) {
  const Trial unseen = asMeasured(subset(trial, held));
  SolvedContacts solved;
  const Eigen::MatrixXd predicted =
      unseen.measured.array().isFinite().select(predictRows(model, unseen, solved), kNaN);
  Eigen::Index from = 0;
  for (std::size_t row = 0; row < held.size(); ++row)
    if (held[row]) all.row(static_cast<Eigen::Index>(row)) = predicted.row(from++);
}

}  // namespace

void keepConfirmed(HeldOut& held, const ModelScope& scope) {
  for (std::size_t c = 0; c < kChannels; ++c)
    if (!scope.kept[c]) held.refined_rmse[c] = held.base_rmse[c];
}

HeldOut holdOut(const TraceResult& result, const TraceOptions& options, const Folds& folds) {
  Eigen::MatrixXd base = Eigen::MatrixXd::Constant(result.trial.rows(), kChannels, kNaN), refined = base;
  for (int fold = 0; fold < folds.count; ++fold) {
    const std::vector<char> held = rowsOf(folds, fold, true), train = rowsOf(folds, fold, false);
    const auto count = std::count(held.begin(), held.end(), 1);
    if (count == 0 || count == result.trial.rows()) continue;
    predictHeld(refittedBase(result, options, train), result.trial, held, base);
    predictHeld(refittedModel(result, options, train), result.trial, held, refined);
  }
  HeldOut held{folds.scheme, rmseOf(base, result.trial), rmseOf(refined, result.trial)};
  keepConfirmed(held, result.scope);
  return held;
}

std::vector<HeldOut> holdOutLevels(const TraceResult& result, const TraceOptions& options) {
  std::vector<HeldOut> all;
  std::set<std::string> columns;
  for (const TracedEffect& e : result.effects) columns.insert(e.chosen.candidate.covariate());
  for (const std::string& column : columns) {
    if (column == "slip" && result.held_out.scheme.find("slip") != std::string::npos) continue;
    const Folds folds = levelFolds(result.trial, column);
    if (folds.count > 0) all.push_back(holdOut(result, options, folds));
  }
  return all;
}

namespace {

using Values = std::vector<double>;

Values valuesOf(const Trial& trial, const std::string& column) {
  Values x;
  for (const WheelState& s : trial.states) x.push_back(s.covariate(column));
  return x;
}

/// Least and greatest finite value over the rows whose mark in `rows` is `wanted`.
std::pair<double, double> rangeOver(const Values& x, const std::vector<char>& rows, char wanted) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t row = 0; row < x.size(); ++row)
    if (rows[row] == wanted && std::isfinite(x[row]))
      low = std::min(low, x[row]), high = std::max(high, x[row]);
  return {low, high};
}

/// Least gap between levels relative to the range of the column: the spacing of 25 even levels. Values with
/// smaller gaps belong to one level.
constexpr double kLevelGap = 0.04;

/// Marks the rows of the outermost of at least three levels, or the outermost tenth of the rows of a column
/// with one level or more than eight. Empty if no rows can be held out.
std::vector<char> outermost(const Values& x, bool high) {
  Values sorted;
  for (double v : x)
    if (std::isfinite(v)) sorted.push_back(high ? -v : v);
  if (sorted.size() < 6) return {};
  std::sort(sorted.begin(), sorted.end());
  const double gap = kLevelGap * (sorted.back() - sorted.front());
  std::vector<double> ends;  // last value of each level
  for (std::size_t k = 0; k < sorted.size(); ++k)
    if (k + 1 == sorted.size() || sorted[k + 1] - sorted[k] > gap) ends.push_back(sorted[k]);
  if (ends.size() == 2) return {};
  const double reach = ends.size() > 1 && ends.size() <= 8 ? ends.front() : sorted[sorted.size() / 10];
  std::vector<char> rows;
  for (double v : x) rows.push_back((high ? -v : v) <= reach);
  const auto held = std::count(rows.begin(), rows.end(), 1);
  return 2 * held > std::ssize(rows) ? std::vector<char>{} : rows;
}

std::set<std::string> columnsOf(const TraceResult& result) {
  std::set<std::string> wanted{"slip", "slip_angle_rad", "load_N"}, there;
  for (const Effect& e : result.refined.effects) wanted.insert(e.covariate);
  for (const std::string& column : result.trial.covariates)
    if (wanted.contains(column)) there.insert(column);
  return there;
}

}  // namespace

bool hasCorrections(const TraceResult& result) {
  return result.refined.effects.size() > result.base.effects.size();
}

std::vector<EndLevel> endLevels(const TraceResult& result, const TraceOptions& options,
                                const ProgressMonitor& watch) {
  std::vector<EndLevel> ends;
  for (const std::string& column : columnsOf(result))
    for (const bool high : {false, true}) {
      if (watch.stopped()) return ends;
      const Values x = valuesOf(result.trial, column);
      const std::vector<char> held = outermost(x, high);
      if (held.empty()) continue;
      const auto [low_seen, high_seen] = rangeOver(x, held, 0);
      EndLevel end{.column = column, .high = high};
      std::vector<char> seen;
      for (std::size_t row = 0; row < x.size(); ++row) {
        seen.push_back(!held[row]);
        if (!held[row]) continue;
        ++end.rows;
        end.distance += squared(x[row] - (high ? high_seen : low_seen));
      }
      end.distance = std::sqrt(end.distance / end.rows);
      const Trial unseen = asMeasured(subset(result.trial, held));
      end.base_rmse = rmseOf(refittedBase(result, options, seen), unseen);
      end.refined_rmse =
          hasCorrections(result)
              ? rmseOf(withinRows(refittedModel(result, options, seen), subset(result.trial, seen)), unseen)
              : end.base_rmse;
      ends.push_back(end);
    }
  return ends;
}

RefinedModel withinRows(RefinedModel model, const Trial& trial) {
  for (Effect& effect : model.effects) {
    if (effect.empirical()) continue;
    const Values x = valuesOf(trial, effect.covariate);
    const auto [low, high] = rangeOver(x, std::vector<char>(x.size(), 1), 1);
    if (low < high) effect.knots = {low, high};
  }
  return model;
}

std::vector<TrainedRange> trainedRanges(const Trial& trial, const std::vector<EndLevel>& ends,
                                        const ChannelErrors& floor) {
  std::vector<TrainedRange> all;
  for (const std::string& column : trial.covariates) {
    const Values x = valuesOf(trial, column);
    const auto [low, high] = rangeOver(x, std::vector<char>(x.size(), 1), 1);
    TrainedRange range{.column = column, .low = low, .high = high};
    // Least squares through 0, each end weighted by its rows.
    for (const bool high_end : {false, true})
      for (std::size_t c = 0; c < kChannels; ++c) {
        double excess = 0.0, distance = 0.0;
        for (const EndLevel& end : ends) {
          const double rmse = std::fmin(end.refined_rmse[c], end.base_rmse[c]);
          if (end.column != column || end.high != high_end || !std::isfinite(rmse)) continue;
          excess += end.rows * (rmse * rmse - floor[c] * floor[c]);
          distance += end.rows * end.distance * end.distance;
        }
        if (excess > 0.0 && distance > 0.0)
          (high_end ? range.above : range.below)[c] = std::sqrt(excess / distance);  // (T49)
      }
    all.push_back(range);
  }
  return all;
}

ModelScope scopeOf(const TraceResult& result) {
  ModelScope scope{.trained = trainedRanges(result.trial, result.ends, result.noise_floor)};
  if (!hasCorrections(result)) return scope;
  scope.base = result.base;
  for (std::size_t c = 0; c < kChannels; ++c)
    scope.kept[c] = !(result.held_out.refined_rmse[c] > result.held_out.base_rmse[c]);  // (T48)
  return scope;
}

Eigen::MatrixXd predictInScope(const TraceResult& result, const Trial& rows) {
  SolvedContacts of_base, of_refined;
  Eigen::MatrixXd predicted = predictRows(result.refined, rows, of_refined);
  if (!result.scope.base) return predicted;
  const Eigen::MatrixXd base = predictRows(*result.scope.base, rows, of_base);
  for (int row = 0; row < rows.rows(); ++row)
    for (std::size_t c = 0; c < kChannels; ++c) {
      const double share = result.scope.share(rows.states[static_cast<std::size_t>(row)], c);
      double& value = predicted(row, static_cast<Eigen::Index>(c));
      value = share * value + (1.0 - share) * base(row, static_cast<Eigen::Index>(c));
    }
  return predicted;
}

}  // namespace talus::terramech
