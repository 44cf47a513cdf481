#pragma once

#include <cmath>

#include <talus/costmap/cost/travel_cost.hpp>

namespace talus::planner {

/// Returns the signed smaller angle from heading `from` to heading `to`, (-pi, pi]; left > 0.
inline double turnBetween_rad(costmap::Direction from, costmap::Direction to) noexcept {
  return std::atan2(from.x * to.y - from.y * to.x, from.x * to.x + from.y * to.y);
}

/// Returns true if `holds`(heading) is true at all sampled headings between two headings, on the side of the
/// smaller angle. The samples are at most `apart_rad` > 0 apart; `from` and `to` themselves are excluded.
template <typename Holds>
bool holdsBetween(costmap::Direction from, costmap::Direction to, double apart_rad, Holds holds) {
  const double turn_rad = turnBetween_rad(from, to);
  const int parts = static_cast<int>(std::ceil(std::abs(turn_rad) / apart_rad));
  for (int k = 1; k < parts; ++k) {
    const double by = turn_rad * k / parts, c = std::cos(by), s = std::sin(by);
    if (!holds(costmap::Direction{from.x * c - from.y * s, from.x * s + from.y * c})) return false;
  }
  return true;
}

}  // namespace talus::planner
