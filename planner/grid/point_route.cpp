#include <algorithm>
#include <array>
#include <cmath>

#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/grid/point_route.hpp>
#include <talus/planner/refine/vertices.hpp>

namespace talus::planner {
namespace {

// Numbers of points, and the most cells of a map that is searched over them: at once, and if fewer found no route.
struct Level {
  PointCounts counts;
  std::size_t at_once, most;
};
constexpr std::array<Level, 3> kLevels{
    {{{3, 1}, ~std::size_t{0}, ~std::size_t{0}}, {{7, 3}, 20'000, 1'000'000}, {{15, 5}, 1'000, 100'000}}};

}  // namespace

Polyline pointRoute(const MotionCost& cost, const Segment& places, double tolerance_m, double most_J,
                    const StopCheck& stop, const Rest& rest, bool more) {
  const maps::Grid& grid = cost.map().grid();
  const double metre_J = rest ? 0.0 : 0.999 * cheapestMetre_J(cost.map());
  const Rest straight = [&](maps::Point at) {
    return std::max(0.0, distance_m(at, places.to) - tolerance_m) * metre_J;
  };
  const PointSearch::Task task{places, tolerance_m, most_J, rest ? rest : straight, stop};
  const auto found = [&](PointCounts counts) {
    Polyline way = offSides(cost, PointSearch(cost, counts)(task, SearchRegion(grid)).points);
    return std::isfinite(cost.along(way)) ? way : Polyline{};
  };
  const std::size_t cells = grid.size();
  std::size_t level = kLevels.size() - 1;
  while (cells > kLevels[level].at_once) --level;
  if (!more) return found(kLevels[level].counts);
  Polyline way;
  while (way.empty() && ++level < kLevels.size() && cells <= kLevels[level].most)
    way = found(kLevels[level].counts);
  return way;
}

}  // namespace talus::planner
