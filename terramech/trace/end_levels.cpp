#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <talus/terramech/trace/end_levels.hpp>
#include <talus/terramech/trace/folds.hpp>
#include <talus/terramech/trace/held_out.hpp>

namespace talus::terramech {
namespace {

using Values = std::vector<double>;

Values valuesOf(const Trial& trial, const std::string& column) {
  Values x;
  for (const WheelState& s : trial.states) x.push_back(s.covariate(column));
  return x;
}

/// Least and greatest finite value of the rows that `rows` marks with `wanted`.
std::pair<double, double> rangeOver(const Values& x, const std::vector<char>& rows, char wanted) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t row = 0; row < x.size(); ++row)
    if (rows[row] == wanted && std::isfinite(x[row]))
      low = std::min(low, x[row]), high = std::max(high, x[row]);
  return {low, high};
}

/// Rows of the outermost level; empty where there is none to spare.
std::vector<char> outermost(const Values& x, bool high) {
  Values sorted;
  for (double v : x)
    if (std::isfinite(v)) sorted.push_back(high ? -v : v);
  if (sorted.size() < 6) return {};
  std::sort(sorted.begin(), sorted.end());
  const double gap = 0.04 * (sorted.back() - sorted.front());
  double reach = sorted.front();
  int levels = 0;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    if (k > 0 && sorted[k] - sorted[k - 1] <= gap) continue;
    if (++levels == 2) reach = sorted[k - 1];
  }
  if (levels == 2) return {};
  if (levels > 8 || levels == 1) reach = sorted[sorted.size() / 10];
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

/// Known forms of a column held at the ends of a range.
void holdAt(RefinedModel& model, const std::string& column, double low, double high) {
  for (Effect& e : model.effects)
    if (!e.empirical() && e.covariate == column) e.knots = {low, high};
}

/// Log-likelihood of errors of the size of the floor, up to what all models share.
double logLikelihood(int rows, const ChannelErrors& rmse, const ChannelErrors& floor) {
  double sum = 0.0;
  for (std::size_t c = 0; c < kChannels; ++c)
    if (std::isfinite(rmse[c]) && floor[c] > 0.0) sum -= 0.5 * rows * std::pow(rmse[c] / floor[c], 2);
  return sum;
}

EndLevel endOf(const TraceResult& result, const TraceOptions& options, const std::string& column, bool high,
               const std::vector<char>& held) {
  const Values x = valuesOf(result.trial, column);
  const auto [low_seen, high_seen] = rangeOver(x, held, 0);
  EndLevel end{.column = column, .high = high, .edge = high ? high_seen : low_seen};
  for (std::size_t row = 0; row < x.size(); ++row)
    if (held[row]) ++end.rows, end.distance += std::pow(x[row] - end.edge, 2);
  end.distance = std::sqrt(end.distance / end.rows);
  std::vector<char> seen;
  for (char row : held) seen.push_back(!row);
  const Trial unseen = subset(result.trial, held);
  end.base_rmse = rmseAsMeasured(refitted(result.base, result, options, seen), unseen);
  RefinedModel refined = refitted(result.refined, result, options, seen);
  const ChannelErrors law = rmseAsMeasured(refined, unseen);
  holdAt(refined, column, low_seen, high_seen);
  const ChannelErrors held_at_edge = rmseAsMeasured(refined, unseen);
  // By more than 1, twice what a number that means nothing gains by chance where it is fitted.
  end.law = logLikelihood(end.rows, law, result.noise_floor) >
            logLikelihood(end.rows, held_at_edge, result.noise_floor) + 1.0;
  end.refined_rmse = end.law ? law : held_at_edge;
  return end;
}

}  // namespace

std::vector<EndLevel> endLevels(const TraceResult& result, const TraceOptions& options,
                                const ProgressMonitor& watch) {
  std::vector<EndLevel> ends;
  for (const std::string& column : columnsOf(result))
    for (const bool high : {false, true}) {
      if (watch.stopped()) return ends;
      const std::vector<char> held = outermost(valuesOf(result.trial, column), high);
      if (!held.empty()) ends.push_back(endOf(result, options, column, high, held));
    }
  return ends;
}

void boundEffects(RefinedModel& model, const Trial& trial, const std::vector<EndLevel>& ends) {
  std::set<std::string> columns;
  for (const Effect& e : model.effects) columns.insert(e.covariate);
  for (const std::string& column : columns) {
    const Values x = valuesOf(trial, column);
    auto [low, high] = rangeOver(x, std::vector<char>(x.size(), 1), 1);
    if (!(low < high)) continue;
    constexpr double kFar = 1e12;  // beyond any column, within what a model file may hold
    for (const EndLevel& end : ends)
      if (end.column == column && end.law) (end.high ? high : low) = end.high ? kFar : -kFar;
    if (low > -kFar || high < kFar) holdAt(model, column, low, high);
  }
}

std::vector<TrainedRange> trainedRanges(const Trial& trial, const std::vector<EndLevel>& ends,
                                        const ChannelErrors& floor) {
  std::vector<TrainedRange> all;
  for (const std::string& column : trial.covariates) {
    const Values x = valuesOf(trial, column);
    const auto [low, high] = rangeOver(x, std::vector<char>(x.size(), 1), 1);
    TrainedRange range{.column = column, .low = low, .high = high};
    for (const EndLevel& end : ends)
      for (std::size_t c = 0; c < kChannels && end.column == column; ++c) {
        const double excess = std::pow(end.refined_rmse[c], 2) - std::pow(floor[c], 2);
        if (excess > 0.0 && end.distance > 0.0)
          (end.high ? range.above : range.below)[c] = std::sqrt(excess) / end.distance;
      }
    all.push_back(range);
  }
  return all;
}

}  // namespace talus::terramech
