#include <algorithm>
#include <cmath>
#include <map>

#include <talus/terramech/calibration/held_out/end_levels.hpp>
#include <talus/terramech/calibration/held_out/model_scope.hpp>
#include <talus/terramech/numerics/normal_distribution.hpp>

namespace talus::terramech {
namespace {

/// True if an end contradicts the refined model: the mean square error exceeds those of the base and of the
/// sensors by more than the 95 % quantile of the same number of normal errors. False for a channel without
/// measurements (NaN).
bool isWorse(const EndLevel& end, const ChannelErrors& floor, std::size_t channel) {
  const double chance = normalQuantile(1.0 - TraceOptions{}.significance) * std::sqrt(2.0 / end.rows);
  const double least = std::max(end.base_rmse[channel], floor[channel]);
  return std::pow(end.refined_rmse[channel], 2) > (1.0 + chance) * least * least;  // (T50)
}

void keep(ChannelErrors& refined, const ChannelErrors& base, const ModelScope& scope) {
  for (std::size_t c = 0; c < kChannels; ++c)
    if (!scope.kept[c]) refined[c] = base[c];
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

void keepConfirmed(HeldOut& held, const ModelScope& scope) {
  keep(held.refined_rmse, held.base_rmse, scope);
  for (GroupErrors& g : held.groups) keep(g.refined_rmse, g.base_rmse, scope);
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
