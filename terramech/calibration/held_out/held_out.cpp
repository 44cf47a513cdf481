#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <talus/common/constants.hpp>
#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/held_out/held_out.hpp>
#include <talus/terramech/calibration/noise/run_likelihood.hpp>
#include <talus/terramech/calibration/noise/whitening.hpp>
#include <talus/terramech/numerics/normal_distribution.hpp>

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

/// Residuals (measured - predicted) with slip and load as measured, rows x kChannels.
Eigen::MatrixXd leftAsMeasured(const RefinedModel& model, const Trial& trial) {
  SolvedContacts solved;
  return trial.measured - predictRows(model, asMeasured(trial), solved);
}

}  // namespace

void SquaredErrors::add(const Eigen::MatrixXd& residual) {
  for (int c = 0; c < kChannels; ++c)
    for (double r : residual.col(c))
      if (std::isfinite(r)) {
        sum_[static_cast<std::size_t>(c)] += r * r;
        ++count_[static_cast<std::size_t>(c)];
      }
}

ChannelErrors SquaredErrors::rmse() const {
  ChannelErrors e{};
  for (std::size_t c = 0; c < kChannels; ++c) e[c] = count_[c] ? std::sqrt(sum_[c] / count_[c]) : kNaN;
  return e;
}

ChannelErrors rmseAsMeasured(const RefinedModel& model, const Trial& trial) {
  return SquaredErrors(leftAsMeasured(model, trial)).rmse();
}

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

/// Errors of one model on all rows, and on the rows of each group.
class Tally {
 public:
  explicit Tally(const std::vector<std::string>& columns) : columns_(columns) {}

  void add(const Trial& unseen, const Eigen::MatrixXd& residual) {
    all_.add(residual);
    for (const std::string& column : columns_)
      for (int row = 0; row < unseen.rows(); ++row) {
        const std::string label{unseen.states[static_cast<std::size_t>(row)].label(column)};
        groups_[{column, label}].add(residual.row(row));
        ++rows_[{column, label}];
      }
  }

  ChannelErrors rmse() const { return all_.rmse(); }

  static std::vector<GroupErrors> groups(const Tally& base, const Tally& refined) {
    std::vector<GroupErrors> all;
    for (const auto& [key, sums] : base.groups_)
      all.push_back({.column = key.first,
                     .value = key.second,
                     .rows = base.rows_.at(key),
                     .base_rmse = sums.rmse(),
                     .refined_rmse = refined.groups_.at(key).rmse()});
    return all;
  }

 private:
  using Key = std::pair<std::string, std::string>;
  std::vector<std::string> columns_;
  SquaredErrors all_;
  std::map<Key, SquaredErrors> groups_;
  std::map<Key, int> rows_;
};

void keep(ChannelErrors& refined, const ChannelErrors& base, const ModelScope& scope) {
  for (std::size_t c = 0; c < kChannels; ++c)
    if (!scope.kept[c]) refined[c] = base[c];
}

std::vector<std::string> columnsOfOneGroup(const RefinedModel& model) {
  std::set<std::string> columns;
  for (const Effect& e : model.effects)
    if (!e.only_column.empty()) columns.insert(e.only_column);
  return {columns.begin(), columns.end()};
}

}  // namespace

void keepConfirmed(HeldOut& held, const ModelScope& scope) {
  keep(held.refined_rmse, held.base_rmse, scope);
  for (GroupErrors& g : held.groups) keep(g.refined_rmse, g.base_rmse, scope);
}

HeldOut holdOut(const TraceResult& result, const TraceOptions& options, const Folds& folds) {
  const Trial& trial = result.trial;
  const auto columns = columnsOfOneGroup(result.refined);
  Tally base{columns}, refined{columns};
  for (int fold = 0; fold < folds.count; ++fold) {
    const std::vector<char> train = rowsOf(folds, fold, false);
    const Trial unseen = subset(trial, rowsOf(folds, fold, true));
    if (unseen.rows() == 0 || unseen.rows() == trial.rows()) continue;
    base.add(unseen, leftAsMeasured(refittedBase(result, options, train), unseen));
    refined.add(unseen, leftAsMeasured(refittedModel(result, options, train), unseen));
  }
  HeldOut held{folds.scheme, base.rmse(), refined.rmse(), Tally::groups(base, refined)};
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
  end.base_rmse = end.refined_rmse = rmseAsMeasured(refittedBase(result, options, seen), unseen);
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
  end.refined_rmse = rmseAsMeasured(earned, unseen);
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

/// True if an end contradicts the refined model: the mean square error exceeds those of the base and of the
/// sensors by more than the 95 % quantile of the same number of normal errors. False for a channel without
/// measurements (NaN).
bool isWorse(const EndLevel& end, const ChannelErrors& floor, std::size_t channel) {
  const double chance = normalQuantile(1.0 - TraceOptions{}.significance) * std::sqrt(2.0 / end.rows);
  const double least = std::max(end.base_rmse[channel], floor[channel]);
  return std::pow(end.refined_rmse[channel], 2) > (1.0 + chance) * least * least;  // (T50)
}

/// Sets the reach of the corrections at one side of a column. `ends`: the ends of this side, the nearest
/// first. Corrections end halfway between the last end that confirms and the first end that contradicts the
/// corrections.
void setReach(std::array<double, kChannels>& reach, const std::vector<EndLevel>& ends,
              const ChannelErrors& floor) {
  for (std::size_t c = 0; c < kChannels; ++c) {
    double confirmed = 0.0;
    for (const EndLevel& end : ends) {
      if (isWorse(end, floor, c)) {
        reach[c] =
            0.5 * 0.5 * (confirmed + end.distance);  // (T51) TrainedRange::share() ends at twice the reach
        break;
      }
      confirmed = end.distance;
    }
  }
}

}  // namespace

ModelScope scopeOf(const TraceResult& result) {
  ModelScope scope{.trained = trainedRanges(result.trial, result.ends, result.noise_floor)};
  if (!hasCorrections(result)) return scope;
  scope.base = result.base;
  for (std::size_t c = 0; c < kChannels; ++c)
    scope.kept[c] = !(result.held_out.refined_rmse[c] > result.held_out.base_rmse[c]);  // (T48)
  std::map<std::pair<std::string, bool>, std::vector<EndLevel>> sides;
  for (const EndLevel& end : result.ends) sides[{end.column, end.high}].push_back(end);
  for (TrainedRange& range : scope.trained)
    for (const bool high : {false, true})
      if (const auto side = sides.find({range.column, high}); side != sides.end())
        setReach(high ? range.reach_above : range.reach_below, side->second, result.noise_floor);
  return scope;
}

void keepConfirmed(std::vector<EndLevel>& ends, const ChannelErrors& floor) {
  for (EndLevel& end : ends)
    for (std::size_t c = 0; c < kChannels; ++c)
      if (isWorse(end, floor, c)) end.refined_rmse[c] = end.base_rmse[c];
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
