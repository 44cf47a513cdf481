#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <talus/terramech/calibration/held_out/held_out.hpp>
#include <talus/terramech/calibration/held_out/model_scope.hpp>
#include <talus/terramech/calibration/noise/folds.hpp>
#include <talus/terramech/numerics/normal_distribution.hpp>

namespace talus::terramech {
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

/// Extent of the held-out end of a column.
enum class Depth { Level, Half };

/// Least gap between levels relative to the range of the column: the spacing of 25 even levels. Values with
/// smaller gaps belong to one level.
constexpr double kLevelGap = 0.04;

/// Marks the rows of the outermost level (Depth::Level) or of the outer levels with at most half of the rows
/// (Depth::Half); without levels the outermost tenth or half. Empty if no rows can be held out.
std::vector<char> outermost(const Values& x, bool high, Depth depth) {
  Values sorted;
  for (double v : x)
    if (std::isfinite(v)) sorted.push_back(high ? -v : v);
  if (sorted.size() < 6) return {};
  std::sort(sorted.begin(), sorted.end());
  const double gap = kLevelGap * (sorted.back() - sorted.front());
  std::vector<std::size_t> ends;  // index of the last row of each level
  for (std::size_t k = 0; k < sorted.size(); ++k)
    if (k + 1 == sorted.size() || sorted[k + 1] - sorted[k] > gap) ends.push_back(k);
  if (ends.size() == 2) return {};
  const bool half = depth == Depth::Half;
  double reach = sorted[half ? (sorted.size() - 1) / 2 : sorted.size() / 10];
  if (ends.size() > 1 && ends.size() <= 8) {
    std::size_t last = 0;
    while (half && 2 * (ends[last + 1] + 1) <= sorted.size()) ++last;
    reach = sorted[ends[last]];
  }
  std::vector<char> rows;
  for (double v : x) rows.push_back((high ? -v : v) <= reach);
  return 2 * std::count(rows.begin(), rows.end(), 1) > static_cast<long>(rows.size()) ? std::vector<char>{}
                                                                                      : rows;
}

std::set<std::string> columnsOf(const TraceResult& result) {
  std::set<std::string> wanted{"slip", "slip_angle_rad", "load_N"}, there;
  for (const Effect& e : result.refined.effects) wanted.insert(e.covariate);
  for (const std::string& column : result.trial.covariates)
    if (wanted.contains(column)) there.insert(column);
  return there;
}

/// Log-likelihood of errors with the standard deviation of the floor, except for a constant common to all
/// models.
double logLikelihood(int rows, const ChannelErrors& rmse, const ChannelErrors& floor) {
  double sum = 0.0;
  for (std::size_t c = 0; c < kChannels; ++c)
    if (std::isfinite(rmse[c]) && floor[c] > 0.0) sum -= 0.5 * rows * std::pow(rmse[c] / floor[c], 2);
  return sum;
}

/// Errors of one end. `level`: result for the outermost level if `held` is Depth::Half, else null; an effect
/// whose formula did not predict the outermost level has reach 0.
EndLevel endOf(const TraceResult& result, const TraceOptions& options, const std::string& column, bool high,
               const std::vector<char>& held, const EndLevel* level) {
  const Values x = valuesOf(result.trial, column);
  const auto [low_seen, high_seen] = rangeOver(x, held, 0);
  EndLevel end{.column = column, .high = high, .edge = high ? high_seen : low_seen};
  double farthest = 0.0;
  std::vector<char> seen;
  for (std::size_t row = 0; row < x.size(); ++row) {
    seen.push_back(!held[row]);
    if (!held[row]) continue;
    const double beyond = std::abs(x[row] - end.edge);
    ++end.rows;
    end.distance += beyond * beyond;
    farthest = std::max(farthest, beyond);
  }
  end.distance = std::sqrt(end.distance / end.rows);
  const Trial unseen = subset(result.trial, held);
  const Eigen::MatrixXd by_base = leftAsMeasured(refittedBase(result, options, seen), unseen);
  end.base_rmse = end.refined_rmse = SquaredErrors(by_base).rmse();
  if (!hasCorrections(result)) return end;
  const RefinedModel by_law = refittedModel(result, options, seen);
  const auto likelihood = [&](const RefinedModel& model) {
    return logLikelihood(end.rows, rmseAsMeasured(model, unseen), result.noise_floor);
  };
  // Gain of an irrelevant parameter by chance: half a quantile of chi-squared with one degree of freedom.
  const double chance = 0.5 * std::pow(normalQuantile(1.0 - 0.5 * options.significance), 2);
  const double reached = likelihood(by_law) - chance;
  RefinedModel earned = by_law;
  end.reach.assign(by_law.effects.size(), 0.0);
  for (std::size_t k = 0; k < end.reach.size(); ++k) {
    if (by_law.effects[k].empirical() || by_law.effects[k].covariate != column) continue;
    RefinedModel at_edge = by_law;
    at_edge.effects[k].knots = {low_seen, high_seen};
    const bool allowed = !level || level->reach[k] > 0.0, better = reached > likelihood(at_edge);  // (T49)
    if (allowed && better) end.reach[k] = farthest;
    const bool law = level ? allowed : better;
    end.law = end.law || law;
    if (!law) earned.effects[k].knots = at_edge.effects[k].knots;
  }
  const Eigen::MatrixXd by_refined = leftAsMeasured(earned, unseen);
  end.refined_rmse = SquaredErrors(by_refined).rmse();
  end.moved = SquaredErrors(by_base - by_refined).rmse();
  return end;
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
      const std::vector<char> level = outermost(x, high, Depth::Level);
      if (level.empty()) continue;
      ends.push_back(endOf(result, options, column, high, level, nullptr));
      const std::vector<char> half = outermost(x, high, Depth::Half);
      if (!hasCorrections(result) || half.empty() || half == level) continue;
      const EndLevel outer = ends.back();
      ends.push_back(endOf(result, options, column, high, half, &outer));
    }
  return ends;
}

void boundEffects(RefinedModel& model, const Trial& trial, const std::vector<EndLevel>& ends) {
  for (std::size_t k = 0; k < model.effects.size(); ++k) {
    Effect& effect = model.effects[k];
    if (effect.empirical()) continue;
    const Values x = valuesOf(trial, effect.covariate);
    const auto [low, high] = rangeOver(x, std::vector<char>(x.size(), 1), 1);
    if (!(low < high)) continue;
    double below = 0.0, above = 0.0;
    for (const EndLevel& end : ends) {
      if (end.column != effect.covariate || k >= end.reach.size()) continue;
      double& reach = end.high ? above : below;
      reach = std::max(reach, end.reach[k]);
    }
    effect.knots = {low - below, high + above};
  }
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
          (high_end ? range.above : range.below)[c] = std::sqrt(excess / distance);  // (T52)
      }
    all.push_back(range);
  }
  return all;
}

namespace {

/// Sum of squared errors of a channel over the rows of an end, with a share of the corrections.
double squaredError(const EndLevel& end, std::size_t c, double share) {
  const double base = std::pow(end.base_rmse[c], 2), moved = std::pow(end.moved[c], 2);
  const double along = 0.5 * (base + moved - std::pow(end.refined_rmse[c], 2));
  return end.rows * std::max(0.0, base + share * (share * moved - 2.0 * along));
}

double shareAt(const TrainedRange& range, const EndLevel& end, std::size_t c) {
  return range.share(end.high ? range.high + end.distance : range.low - end.distance, c);
}

/// Sets the reach of the corrections of a channel at one side of a column: of the reaches that give one end its
/// least-squares share, the one with the least error over all ends of this side.
void setReach(TrainedRange& range, bool high, const std::vector<EndLevel>& ends, std::size_t c) {
  double& reach = (high ? range.reach_above : range.reach_below)[c];
  std::vector<double> reaches{kUnlimited};
  for (const EndLevel& end : ends) {
    if (end.column != range.column || end.high != high || !(end.moved[c] > 0.0)) continue;
    const double gained = squaredError(end, c, 0.0) - squaredError(end, c, 1.0);
    const double share = 0.5 + 0.5 * gained / (end.rows * std::pow(end.moved[c], 2));  // (T50)
    if (share < 1.0) reaches.push_back(end.distance / (2.0 - std::max(0.0, share)));   // (T51)
  }
  double least = std::numeric_limits<double>::infinity(), best = kUnlimited;
  for (const double candidate : reaches) {
    reach = candidate;
    double sum = 0.0;
    for (const EndLevel& end : ends)
      if (end.column == range.column && end.high == high && end.moved[c] > 0.0)
        sum += squaredError(end, c, shareAt(range, end, c));
    if (sum < least) least = sum, best = candidate;
  }
  reach = best;
}

}  // namespace

ModelScope scopeOf(const TraceResult& result) {
  ModelScope scope{.trained = trainedRanges(result.trial, result.ends, result.noise_floor)};
  if (!hasCorrections(result)) return scope;
  scope.base = result.base;
  for (std::size_t c = 0; c < kChannels; ++c) {
    scope.kept[c] = !(result.held_out.refined_rmse[c] > result.held_out.base_rmse[c]);  // (T48)
    for (TrainedRange& range : scope.trained)
      for (const bool high : {false, true}) setReach(range, high, result.ends, c);
  }
  return scope;
}

void keepConfirmed(std::vector<EndLevel>& ends, const ModelScope& scope) {
  for (EndLevel& end : ends)
    for (const TrainedRange& range : scope.trained)
      for (std::size_t c = 0; scope.base && range.column == end.column && c < kChannels; ++c)
        end.refined_rmse[c] =
            std::sqrt(squaredError(end, c, scope.kept[c] ? shareAt(range, end, c) : 0.0) / end.rows);
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
