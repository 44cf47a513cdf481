#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include <talus/planner/bound/mesh_route.hpp>

namespace talus::planner {
namespace {

using maps::Cell;
using maps::Point;

constexpr double kUphill = 1e-4;  // relative increase of the value allowed if no step leads down
constexpr double kBeside = 0.02;  // distance kept from corners [cell sides]
constexpr double kEdge = 1e-6;    // a point this close to a grid line lies on the line [cell sides]

// Traces a route back from the goal by descending the values of a search from the start.
class Descent {
 public:
  Descent(const MotionCost& cost, const MeshSearch& from_start, const CellMesh& mesh)
      : map_(cost.map()), search_(from_start), mesh_(mesh), side_m_(mesh.grid().resolution_m) {}

  Polyline between(const Segment& places) {
    const maps::Grid& grid = mesh_.grid();
    const Point start = local(places.from);
    Polyline points{places.to};
    Point at = local(places.to);
    double value = std::numeric_limits<double>::infinity();
    const std::size_t most = 4 * static_cast<std::size_t>(grid.width + grid.height) + grid.size() / 8;
    while (points.size() < most) {
      if (startsBeside(at, start)) {
        points.push_back(places.from);
        std::ranges::reverse(points);
        return points;
      }
      visited_.insert(keyOf(at));
      auto next = bestFrom(at, value);
      if (!next) next = bestFrom(at, value + kUphill * std::abs(value));
      if (!next) return {};
      at = next->at;
      value = next->value;
      points.push_back({grid.south_west.x_m + at.x_m * side_m_, grid.south_west.y_m + at.y_m * side_m_});
    }
    return {};
  }

 private:
  struct Step {
    Point at;
    double value = 0.0, through = 0.0;
  };

  // Column and row coordinate of a point, in units of 1/50 of a cell side, rounded.
  using Key = std::pair<long, long>;
  static Key keyOf(Point at) noexcept { return {std::lround(50.0 * at.x_m), std::lround(50.0 * at.y_m)}; }

  // Coordinates in cell sides from the grid's south-west corner.
  Point local(Point place) const noexcept {
    return {(place.x_m - mesh_.grid().south_west.x_m) / side_m_,
            (place.y_m - mesh_.grid().south_west.y_m) / side_m_};
  }

  // Calls each() for every cell that contains or touches a point.
  template <typename Each>
  void forEachCell(Point at, Each each) const {
    const auto low = [](double x) { return static_cast<int>(std::ceil(x - kEdge)) - 1; };
    const auto high = [](double x) { return static_cast<int>(std::floor(x + kEdge)); };
    for (int row = low(at.y_m); row <= high(at.y_m); ++row)
      for (int column = low(at.x_m); column <= high(at.x_m); ++column)
        if (mesh_.grid().contains({column, row})) each(Cell{column, row});
  }

  // Returns true if the start lies in a cell that contains or touches the point, and the heading from the
  // start to the point is allowed in that cell.
  bool startsBeside(Point at, Point start) const {
    bool found = false;
    forEachCell(at, [&](Cell cell) {
      const double x = start.x_m - cell.column, y = start.y_m - cell.row;
      if (!(x >= 0.0 && x <= 1.0 && y >= 0.0 && y <= 1.0)) return;
      const double dx = at.x_m - start.x_m, dy = at.y_m - start.y_m, length = std::hypot(dx, dy);
      found = found || length <= kEdge || allowed(cell, {dx / length, dy / length});
    });
    return found;
  }

  bool allowed(Cell cell, const costmap::Direction& heading) const {
    return std::isfinite(map_.cost().costPerMetre(map_.at(cell), heading));
  }

  std::optional<Step> bestFrom(Point at, double below) const {
    std::optional<Step> best;
    forEachCell(at, [&](Cell cell) {
      const auto look = [&](const costmap::Direction& back) { consider(cell, at, back, below, best); };
      for (int k = 0; k < DirectionalCostBounds::kHeadings; ++k) look(DirectionalCostBounds::heading(k));
      for (const double x : {0.0, 1.0})
        for (const double y : {0.0, 1.0}) {
          const double dx = cell.column + x - at.x_m, dy = cell.row + y - at.y_m, length = std::hypot(dx, dy);
          if (length > kEdge) look({dx / length, dy / length});
        }
    });
    return best;
  }

  void consider(Cell cell, Point at, const costmap::Direction& back, double below,
                std::optional<Step>& best) const {
    const double x = at.x_m - cell.column, y = at.y_m - cell.row;
    const auto reach = [](double from, double along) {
      if (along > 0.0) return (1.0 - from) / along;
      return along < 0.0 ? -from / along : std::numeric_limits<double>::infinity();
    };
    const double to_x = reach(x, back.x), to_y = reach(y, back.y), most = std::min(to_x, to_y);
    if (!(most > kEdge)) return;
    const bool to_side = to_x < to_y;
    const double side = (to_side ? back.x : back.y) > 0.0 ? 1.0 : 0.0,
                 met = std::clamp(to_side ? y + most * back.y : x + most * back.x, 0.0, 1.0);
    // Prefers points slightly off corners and sides, where only one cell determines the cost, if the heading
    // is allowed.
    for (const double along : {std::clamp(met, kBeside, 1.0 - kBeside), met})
      if (step(cell, {x, y}, to_side ? Point{side, along} : Point{along, side}, below, best)) return;
  }

  // Updates `best` with one step. Returns false if the step is not allowed or has no length.
  bool step(Cell cell, Point from, Point out, double below, std::optional<Step>& best) const {
    const double dx = out.x_m - from.x_m, dy = out.y_m - from.y_m, length = std::hypot(dx, dy);
    if (!(length > kEdge)) return false;
    const auto price =
        static_cast<double>(map_.cost().costPerMetre(map_.at(cell), {-dx / length, -dy / length}));
    if (!std::isfinite(price)) return false;
    const Point at{cell.column + out.x_m, cell.row + out.y_m};
    const double value = valueOn(cell, out), through = value + price * length * side_m_;
    if (value < below && !(best && best->through <= through) && !visited_.contains(keyOf(at)))
      best = Step{at, value, through};
    return true;
  }

  // Search value on the border of a cell, linear between the corners.
  double valueOn(Cell cell, Point out) const {
    const CellMesh::Nodes nodes = mesh_.nodesOf(cell);
    const auto v = [&](std::size_t k) {
      const float value = search_.at(nodes[k]);
      return value < MeshSearch::kFar ? static_cast<double>(value) : std::numeric_limits<double>::infinity();
    };
    const auto between = [](double a, double b, double share) {
      if (share <= 0.0) return a;
      return share >= 1.0 ? b : a + share * (b - a);
    };
    if (out.y_m <= kEdge) return between(v(0), v(1), out.x_m);
    if (out.y_m >= 1.0 - kEdge) return between(v(3), v(2), out.x_m);
    return out.x_m <= kEdge ? between(v(0), v(3), out.y_m) : between(v(1), v(2), out.y_m);
  }

  const costmap::CostGrid& map_;
  const MeshSearch& search_;
  const CellMesh& mesh_;
  double side_m_;
  std::set<Key> visited_;
};

// Moves vertices on cell sides into one of the adjacent cells, choosing the cheaper one.
void leaveSides(const MotionCost& cost, Polyline& points) {
  const double off_m = kBeside * cost.map().grid().resolution_m;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Point here = points[i];
    double best_J = std::numeric_limits<double>::infinity();
    for (const double share : {-1.0, 1.0}) {
      const Point& end = points[share < 0.0 ? i - 1 : i + 1];
      const double length_m = distance_m(here, end), s = std::min(off_m / length_m, 0.5);
      const Point moved{here.x_m + s * (end.x_m - here.x_m), here.y_m + s * (end.y_m - here.y_m)};
      const double legs_J = cost.along({points[i - 1], moved, points[i + 1]});
      if (!(legs_J < best_J)) continue;
      best_J = legs_J;
      points[i] = moved;
    }
  }
}

}  // namespace

Polyline meshRoute(const MotionCost& cost, const MeshSearch& from_start, const CellMesh& mesh,
                   const Segment& places) {
  Polyline points = Descent(cost, from_start, mesh).between(places);
  if (points.size() < 2) return {};
  leaveSides(cost, points);
  return points;
}

}  // namespace talus::planner
