#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <talus/common/constants.hpp>
#include <talus/planner/refine/settled_vertices.hpp>

namespace talus::planner {
namespace {

constexpr std::array kSteps{0.2, 0.1, 0.05, 0.025, 0.0125};  // cells
constexpr int kSweeps = 4;                                   // largest number of sweeps per step
constexpr std::array kOff{0.02, 0.005, 0.001, 2e-4, 2e-5};   // distance from a side [cells]
constexpr double kOnCircle = 1e-6, kInside = 1.0 - 1e-9;     // relative to the tolerance
// Smallest gain relative to the local cost; smaller gains are rounding.
constexpr double kLeastGain = 1e-9;

// Returns the cost [J] of the legs from vertex i - 2 to vertex i + 2, turns between them included. All costs
// that depend on the place of vertex i are among them.
double around_J(const MotionCost& cost, const Polyline& points, std::size_t i) {
  const std::size_t first = i > 1 ? i - 2 : 0, last = std::min(i + 2, points.size() - 1);
  return cost.along({points.begin() + static_cast<std::ptrdiff_t>(first),
                     points.begin() + static_cast<std::ptrdiff_t>(last) + 1});
}

// Moves vertex i by one step in the cheapest of eight directions. Returns false if no direction is cheaper.
bool moved(const MotionCost& cost, Polyline& points, std::size_t i, double step_m) {
  const double before_J = around_J(cost, points, i);
  const maps::Point here = points[i];
  maps::Point best = here;
  double best_J = before_J * (1.0 - kLeastGain);
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y) {
      if (x == 0 && y == 0) continue;
      points[i] = {here.x_m + x * step_m, here.y_m + y * step_m};
      const double tried_J = around_J(cost, points, i);
      if (tried_J < best_J) best_J = tried_J, best = points[i];
    }
  points[i] = best;
  return !(best == here);
}

}  // namespace

Polyline withSettledVertices(const MotionCost& cost, Polyline points, const StopCheck& stop) {
  if (!(cost.along(points) < kInfinity)) return points;
  for (const double cells : kSteps) {
    bool any = true;
    for (int sweep = 0; sweep < kSweeps && any && !stop(); ++sweep) {
      any = false;
      for (std::size_t i = 1; i + 1 < points.size(); ++i)
        any = moved(cost, points, i, cells * cost.map().grid().resolution_m) || any;
    }
  }
  return points;
}

Polyline withSettledEnd(const MotionCost& cost, Polyline points, maps::Point goal, double tolerance_m) {
  if (points.size() < 2 || std::abs(distance_m(points.back(), goal) - tolerance_m) > kOnCircle * tolerance_m)
    return points;
  const std::size_t first = points.size() > 2 ? points.size() - 3 : 0;
  const auto end_J = [&] {
    return cost.along({points.begin() + static_cast<std::ptrdiff_t>(first), points.end()});
  };
  double angle = std::atan2(points.back().y_m - goal.y_m, points.back().x_m - goal.x_m), best_J = end_J();
  const double most_rad = cost.map().grid().resolution_m / tolerance_m;
  for (const double cells : {1.6, 0.8, 0.4, 0.2, 0.1, 0.05, 0.025})
    for (int tries = 0; tries < kSweeps; ++tries) {
      const double before = angle;
      for (const double way : {-1.0, 1.0}) {
        const double tried = before + way * std::min(cells * most_rad, 1.0);
        const maps::Point kept = points.back();
        points.back() = {goal.x_m + kInside * tolerance_m * std::cos(tried),
                         goal.y_m + kInside * tolerance_m * std::sin(tried)};
        const double tried_J = end_J();
        if (tried_J < best_J * (1.0 - kLeastGain))
          best_J = tried_J, angle = tried;
        else
          points.back() = kept;
      }
      if (angle == before) break;
    }
  return points;
}

Polyline offSides(const MotionCost& cost, Polyline points) {
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const maps::Point here = points[i];
    // Turns before the vertex are allowed and must remain allowed; later turns are processed next.
    const auto until = points.begin() + static_cast<std::ptrdiff_t>(i) + 2;
    const auto with_J = [&](maps::Point place) {
      points[i] = place;
      return cost.along({until - std::min<std::ptrdiff_t>(4, until - points.begin()), until});
    };
    double best_J = with_J(here);
    if (best_J < kInfinity) continue;
    maps::Point best = here;
    for (const std::size_t to : {i - 1, i + 1})
      for (const double cells : kOff)
        for (const double sense : {1.0, -1.0}) {
          const maps::Point end = points[to];
          const double share =
              sense * std::min(cells * cost.map().grid().resolution_m / distance_m(here, end), 0.5);
          const maps::Point tried{here.x_m + share * (end.x_m - here.x_m),
                                  here.y_m + share * (end.y_m - here.y_m)};
          const double tried_J = with_J(tried);
          if (tried_J < best_J) best_J = tried_J, best = tried;
        }
    points[i] = best;
  }
  return points;
}

}  // namespace talus::planner
