#include <cmath>
#include <limits>

#include <talus/planner/refine/close_vertices.hpp>

namespace talus::planner {

Polyline withoutCloseVertices(const MotionCost& cost, Polyline points) {
  const double least_m = 0.01 * cost.map().grid().resolution_m;
  for (std::size_t i = 0; i + 1 < points.size();) {
    const maps::Point a = points[i], b = points[i + 1];
    const bool first = i == 0, last = i + 2 == points.size();
    if (std::hypot(b.x_m - a.x_m, b.y_m - a.y_m) >= least_m || (first && last)) {
      ++i;
      continue;
    }
    // The stretch around the pair, extended by one vertex on each side to include the turns at its ends.
    const std::size_t from = i >= 2 ? i - 2 : 0, to = std::min(i + 4, points.size());
    std::vector<maps::Point> meeting;
    if (first || last)
      meeting = {first ? a : b};
    else
      meeting = {a, b, {0.5 * (a.x_m + b.x_m), 0.5 * (a.y_m + b.y_m)}};
    double least_J = std::numeric_limits<double>::infinity();
    maps::Point best{};
    for (const maps::Point& p : meeting) {
      Polyline stretch(points.begin() + static_cast<std::ptrdiff_t>(from),
                       points.begin() + static_cast<std::ptrdiff_t>(i));
      stretch.push_back(p);
      stretch.insert(stretch.end(), points.begin() + static_cast<std::ptrdiff_t>(i + 2),
                     points.begin() + static_cast<std::ptrdiff_t>(to));
      if (const double sum_J = cost.along(stretch); sum_J < least_J) {
        least_J = sum_J;
        best = p;
      }
    }
    if (!std::isfinite(least_J)) {
      ++i;
      continue;
    }
    points[i] = best;
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(i + 1));
    i = i > 0 ? i - 1 : 0;
  }
  return points;
}

}  // namespace talus::planner
