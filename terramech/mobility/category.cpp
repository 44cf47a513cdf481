#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include <talus/common/common.hpp>
#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/numerics/gauss_legendre.hpp>

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
         std::isnan(c.torque_over_load_radius.value_or(0.0)) || std::isnan(c.slip.value_or(0.0));
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
  check.within("steering_slip", t.steering_slip.value_or(0.0), {0.0, 1.0});
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
  if (condition.slip) rank += demotion(*condition.slip, {}, t.steering_slip);
  return static_cast<Category>(std::min(rank, kDangerous));
}

namespace {

/// Limits of the middle one of the three bands of a quantity.
struct Bands {
  double low, high;
};

/// Limits of a band in standard deviations from the mean. For an exact quantity (std 0) the limits of its
/// band are -infinity and infinity (probability 1), and both limits of the other bands are infinity.
Bands standardised(Bands edges, int band, double mean, double std, int known_band) {
  if (std == 0.0) return band == known_band ? Bands{-kInfinity, kInfinity} : Bands{kInfinity, kInfinity};
  const double low = (edges.low - mean) / std, high = (edges.high - mean) / std;
  return band == 0 ? Bands{-kInfinity, low} : band == 1 ? Bands{low, high} : Bands{high, kInfinity};
}

void check(const ConditionEstimate& belief) {
  const RangeCheck range{"category belief"};
  range.finite("drawbar_pull_over_load", belief.mean.drawbar_pull_over_load);
  range.finite("sinkage_over_radius", belief.mean.sinkage_over_radius);
  range.atLeast("drawbar_pull_over_load_std", belief.drawbar_pull_over_load_std, 0.0);
  range.atLeast("sinkage_over_radius_std", belief.sinkage_over_radius_std, 0.0);
  range.within("correlation", belief.correlation, {-1.0, 1.0});
}

/// Category of a pair of bands of drawbar pull DP/W and sinkage z/r, with torque and slip of the mean.
Category categoryOf(const ConditionEstimate& belief, const CategoryThresholds& t, int pull_band,
                    int sinkage_band) {
  WheelCondition condition = belief.mean;
  condition.drawbar_pull_over_load = pull_band == 0   ? t.dp_low - 1.0
                                     : pull_band == 1 ? t.dp_low
                                                      : t.dp_high + 1.0;
  condition.sinkage_over_radius = sinkage_band == 0   ? t.z_threshold - 1.0
                                  : sinkage_band == 1 ? t.z_threshold
                                                      : t.z_critical + 1.0;
  return categorise(condition, t);
}

}  // namespace

double probability(const NormalRectangle& q) {
  // int phi(y) [Phi((x2 - rho y)/s) - Phi((x1 - rho y)/s)] dy, in panels no wider than the transition of Phi.
  constexpr auto kRule = gaussLegendre<8>();
  const double rho = std::clamp(q.correlation, -0.999, 0.999), s = std::sqrt(1.0 - rho * rho);
  const double low = std::max(q.y1, -8.5), high = std::min(q.y2, 8.5);
  if (!(low < high) || !(q.x1 < q.x2)) return 0.0;
  const double width = std::min(0.5, 3.0 * s / std::max(std::abs(rho), 1e-3));
  const int panels = static_cast<int>(std::ceil((high - low) / width));
  const double panel = (high - low) / panels;
  double sum = 0.0;
  for (int k = 0; k < panels; ++k)
    for (std::size_t i = 0; i < kRule.node.size(); ++i) {
      const double y = low + panel * (k + kRule.node[i]);
      sum += kRule.weight[i] * normalDensity(y) *
             (normalProbability((q.x2 - rho * y) / s) - normalProbability((q.x1 - rho * y) / s));
    }
  return sum * panel;
}

CategoryProbability categoryProbability(const ConditionEstimate& belief, const CategoryThresholds& t) {
  check(belief);
  validate(t);
  const double pull = belief.mean.drawbar_pull_over_load, sinkage = belief.mean.sinkage_over_radius;
  const int pull_band = pull < t.dp_low ? 0 : pull > t.dp_high ? 2 : 1;
  const int sinkage_band = sinkage > t.z_critical ? 2 : sinkage < t.z_threshold ? 0 : 1;
  CategoryProbability sum{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Bands x =
          standardised({t.dp_low, t.dp_high}, i, pull, belief.drawbar_pull_over_load_std, pull_band);
      const Bands y = standardised({t.z_threshold, t.z_critical}, j, sinkage, belief.sinkage_over_radius_std,
                                   sinkage_band);
      sum[static_cast<std::size_t>(categoryOf(belief, t, i, j))] +=
          probability({x.low, x.high, y.low, y.high, belief.correlation});
    }
  const double total = sum[0] + sum[1] + sum[2];
  for (double& p : sum) p /= total;
  return sum;
}

}  // namespace talus::terramech
