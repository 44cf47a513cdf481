#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <talus/planner/bound/sub_solution.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {
namespace {

using maps::Cell;
using maps::Point;

double value(const SubSolution& u, std::uint32_t node) noexcept {
  return static_cast<double>(u.at(node));
}

// Returns the largest ratio, in one cell, of the solution's fall over a side's length along a heading to the
// heading's limit.
double worstIn(const SubSolution& u, const CellMesh::Nodes& nodes, const TriangleCosts& limits) noexcept {
  static constexpr std::array<std::array<double, 2>, 4> kCorners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  double worst = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t l = CellMesh::next(k);
    if (!u.inner(nodes[k]) && !u.inner(nodes[l]) && !u.inner(nodes[CellMesh::kMiddle])) continue;
    // Gradient from the corner values relative to the centre's value.
    const double ax = kCorners[k][0] - 0.5, ay = kCorners[k][1] - 0.5, bx = kCorners[l][0] - 0.5,
                 by = kCorners[l][1] - 0.5, det = ax * by - bx * ay;
    const double a = value(u, nodes[k]) - value(u, nodes[CellMesh::kMiddle]),
                 b = value(u, nodes[l]) - value(u, nodes[CellMesh::kMiddle]);
    const double x = (a * by - b * ay) / det, y = (b * ax - a * bx) / det;
    for (int h = 0; h < DirectionalCostBounds::kHeadings; ++h) {
      const costmap::Direction d = DirectionalCostBounds::heading(h);
      const double fall = -(x * d.x + y * d.y);
      const auto limit = static_cast<double>(limits.prices[static_cast<std::size_t>(h)]);
      if (fall > worst * limit) worst = fall / limit;
    }
  }
  return worst;
}

// Returns the value [J] of the solution at a place, linear on each triangle; empty outside the solution.
std::optional<double> valueAt(const SubSolution& u, Point place) {
  const maps::Grid& grid = u.mesh().grid();
  const auto cell = grid.cellAt(place);
  if (!cell || u.pricesOf(*cell) == nullptr) return std::nullopt;
  const CellMesh::Nodes nodes = u.mesh().nodesOf(*cell);
  const Point middle = grid.centre(*cell);
  const double x = (place.x_m - middle.x_m) / grid.resolution_m,
               y = (place.y_m - middle.y_m) / grid.resolution_m;
  const std::size_t k = std::abs(y) >= std::abs(x) ? (y < 0.0 ? 0 : 2) : (x > 0.0 ? 1 : 3);
  const double out = 2.0 * std::max(std::abs(x), std::abs(y));  // 0 at the centre, 1 on the side
  const std::array<double, 4> along{x, y, -x, -y};
  const double second = 0.5 * out + along[k], first = out - second;
  const std::uint32_t a = nodes[k], b = nodes[CellMesh::next(k)], m = nodes[CellMesh::kMiddle];
  if (!u.inner(a) && !u.inner(b) && !u.inner(m)) return std::nullopt;
  return first * value(u, a) + second * value(u, b) + (1.0 - out) * value(u, m);
}

// Largest value of the solution among the places where a route may end.
std::optional<double> atGoal(const SubSolution& u, const SubSolution::Parts& parts) {
  if (parts.goal_tolerance_m <= 0.0) return valueAt(u, parts.places.to);
  double most = std::numeric_limits<double>::lowest();
  for (const Cell cell : cellsWithin(u.mesh().grid(), parts.places.to, parts.goal_tolerance_m))
    if (u.pricesOf(cell) != nullptr)
      for (const std::uint32_t node : u.mesh().nodesOf(cell)) most = std::max(most, value(u, node));
  return most;
}

}  // namespace

Proof provenBy(const SubSolution& u, const SubSolution::Parts& parts) {
  const maps::Grid& grid = u.mesh().grid();
  const auto goal = atGoal(u, parts);
  if (!goal) return {};
  double worst = 1.0;
  std::vector<std::pair<double, double>> ways;  // cost before a side, value of the solution there
  if (const auto start = valueAt(u, parts.places.from)) ways.emplace_back(0.0, *start);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const TriangleCosts* limits = u.pricesOf({column, row});
      if (limits == nullptr) continue;
      const CellMesh::Nodes nodes = u.mesh().nodesOf({column, row});
      worst = std::max(worst, worstIn(u, nodes, *limits));
      const auto before_J = static_cast<double>(u.fromStartIn({column, row}));
      for (const std::uint32_t node : nodes)
        if (!u.inner(node) && u.at(node) < SubSolution::kFar) ways.emplace_back(before_J, value(u, node));
    }
  double bound_J = parts.most_J;
  for (const auto& [before_J, value_J] : ways)
    bound_J = std::min(bound_J, before_J + (value_J - *goal) / worst);
  return std::isfinite(bound_J) ? Proof{std::max(0.0, bound_J), worst} : Proof{};
}

}  // namespace talus::planner
