#include <algorithm>
#include <cmath>

#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/grid/point_route.hpp>
#include <talus/planner/refine/vertices.hpp>

namespace talus::planner {
namespace {

constexpr PointCounts kFinest{15, 5}, kFine{7, 3}, kCoarse{3, 1};
constexpr std::size_t kTinyCells = 1'000, kFinestCells = 5'000, kFineCells = 20'000;

}  // namespace

Polyline pointRoute(const MotionCost& cost, const Segment& places, double tolerance_m, double most_J,
                    const StopCheck& stop, const Rest& rest) {
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
  if (cells > kFineCells) return found(kCoarse);
  Polyline way = found(cells > kTinyCells ? kFine : kFinest);
  return way.empty() && cells > kTinyCells && cells <= kFinestCells ? found(kFinest) : way;
}

}  // namespace talus::planner
