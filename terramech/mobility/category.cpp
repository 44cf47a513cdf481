#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

namespace {

constexpr int kSafe = 0, kMarginal = 1, kDangerous = 2;

int rankOf(double dp, const CategoryThresholds& t) {
  if (dp < t.dp_low) return kDangerous;
  return dp > t.dp_high ? kSafe : kMarginal;
}

/// Number of levels by which a quantity with an upper limit lowers the category.
int demotion(double value, std::optional<double> threshold, std::optional<double> critical) {
  if (critical && value > *critical) return kDangerous;
  return threshold && !(value < *threshold) ? 1 : 0;
}

bool unknown(const WheelCondition& c) {
  return std::isnan(c.drawbar_pull_over_load) || std::isnan(c.sinkage_over_radius) ||
         std::isnan(c.torque_over_load_radius.value_or(0.0));
}

void checkOrder(const char* what, double low, double high) {
  if (low <= high) return;
  throw std::invalid_argument(std::string("category thresholds: ") + what + " = " + std::to_string(low) +
                              ", must be <= " + std::to_string(high));
}

}  // namespace

const char* name(Category category) {
  constexpr const char* kNames[] = {"safe", "marginal", "dangerous", "unknown"};
  return kNames[static_cast<int>(category)];
}

CategoryThresholds thresholds(const MissionSlope& mission) {
  const RangeCheck check{"mission slope"};
  check.within("slope_rad", mission.slope_rad, {0.0, 1.57});
  check.within("margin_rad", mission.margin_rad, {0.0, 1.57 - mission.slope_rad});
  return {.dp_low = std::tan(mission.slope_rad - mission.margin_rad),
          .dp_high = std::tan(mission.slope_rad + mission.margin_rad)};
}

void validate(const CategoryThresholds& t) {
  const RangeCheck check{"category thresholds"};
  check.finite("dp_low", t.dp_low);
  check.finite("dp_high", t.dp_high);
  check.finite("z_threshold", t.z_threshold);
  check.finite("z_critical", t.z_critical);
  check.finite("t_threshold", t.t_threshold.value_or(0.0));
  check.finite("t_critical", t.t_critical.value_or(0.0));
  checkOrder("dp_low", t.dp_low, t.dp_high);
  checkOrder("z_threshold", t.z_threshold, t.z_critical);
  if (t.t_threshold && t.t_critical) checkOrder("t_threshold", *t.t_threshold, *t.t_critical);
}

Category categorise(const WheelCondition& condition, const CategoryThresholds& t) {
  if (unknown(condition)) return Category::Unknown;
  int rank = rankOf(condition.drawbar_pull_over_load, t);
  rank += demotion(condition.sinkage_over_radius, t.z_threshold, t.z_critical);
  if (condition.torque_over_load_radius)
    rank += demotion(*condition.torque_over_load_radius, t.t_threshold, t.t_critical);
  return static_cast<Category>(std::min(rank, kDangerous));
}

namespace {

/// Probabilities of the three bands of an estimate below, between and above two limits. An exact value lies in
/// `band`.
std::array<double, 3> bandsOf(const Estimate& x, double low, double high, std::size_t band) {
  std::array<double, 3> bands{};
  if (x.std == 0.0) {
    bands[band] = 1.0;
    return bands;
  }
  const double below_low = normalProbability((low - x.value) / x.std),
               below_high = normalProbability((high - x.value) / x.std);
  return {below_low, below_high - below_low, 1.0 - below_high};
}

void check(const UncertainWheel& wheel) {
  const RangeCheck range{"category belief"};
  range.finite("drawbar_pull_over_load", wheel.drawbar_pull_over_load.value);
  range.finite("sinkage_over_radius", wheel.sinkage_over_radius.value);
  range.atLeast("drawbar_pull_over_load_std", wheel.drawbar_pull_over_load.std, 0.0);
  range.atLeast("sinkage_over_radius_std", wheel.sinkage_over_radius.std, 0.0);
}

}  // namespace

CategoryProbability categoryProbability(const UncertainWheel& wheel, const CategoryThresholds& t) {
  check(wheel);
  const auto pull_rank = static_cast<std::size_t>(rankOf(wheel.drawbar_pull_over_load.value, t)),
             sinkage_rank = static_cast<std::size_t>(
                 demotion(wheel.sinkage_over_radius.value, t.z_threshold, t.z_critical));
  const auto pulls = bandsOf(wheel.drawbar_pull_over_load, t.dp_low, t.dp_high, kDangerous - pull_rank);
  const auto sinkages = bandsOf(wheel.sinkage_over_radius, t.z_threshold, t.z_critical, sinkage_rank);
  CategoryProbability sum{};
  for (std::size_t i = 0; i < pulls.size(); ++i)
    for (std::size_t j = 0; j < sinkages.size(); ++j)
      sum[std::min<std::size_t>(kDangerous - i + j, kDangerous)] += pulls[i] * sinkages[j];
  return sum;
}

}  // namespace talus::terramech
