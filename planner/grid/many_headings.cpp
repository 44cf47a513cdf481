#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

#include <talus/common/constants.hpp>
#include <talus/planner/grid/many_headings.hpp>
#include <talus/planner/grid/node_route.hpp>
#include <talus/planner/route/cells_within.hpp>
#include <talus/planner/route/heading_cost.hpp>

namespace talus::planner {
namespace {

using maps::Cell;
using maps::Point;

constexpr int kFar = 3;  // largest number of cells that a leg spans along an axis

// Leg between two cell centres, with the cells that it crosses or touches and its length in each cell [cell
// sides].
struct Leg {
  struct Crossed {
    Cell offset;
    float length;  // 0: touched at a corner; the cell must allow the heading
  };
  Cell offset;
  costmap::Direction heading;
  std::vector<Crossed> cells;
};

// Returns the straight leg to the centre of the cell at `offset`. Coordinates on the leg are in cells from
// the centre of the first cell.
Leg legTo(Cell offset) {
  const double dx = offset.column, dy = offset.row, length = std::hypot(dx, dy);
  Leg leg{offset, {dx / length, dy / length}, {}};
  std::vector<double> cuts{0.0, 1.0};
  for (const double along : {dx, dy})
    for (int k = 0; k < std::abs(static_cast<int>(along)); ++k) cuts.push_back((k + 0.5) / std::abs(along));
  std::ranges::sort(cuts);
  const auto cellAt = [](double x, double y) {
    return Cell{static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y))};
  };
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    const double middle = 0.5 * (cuts[i] + cuts[i - 1]), share = cuts[i] - cuts[i - 1];
    if (share > 1e-9) {
      leg.cells.push_back({cellAt(middle * dx, middle * dy), static_cast<float>(share * length)});
      continue;
    }
    // Two cuts coincide at a corner: the other two cells at the corner.
    for (const double side : {-0.25, 0.25})
      leg.cells.push_back(
          {cellAt(cuts[i] * dx - side * std::copysign(1.0, dx), cuts[i] * dy + side * std::copysign(1.0, dy)),
           0.0F});
  }
  return leg;
}

std::vector<Leg> allLegs() {
  std::vector<Leg> legs;
  for (int row = -kFar; row <= kFar; ++row)
    for (int column = -kFar; column <= kFar; ++column)
      if (std::gcd(std::abs(row), std::abs(column)) == 1) legs.push_back(legTo({column, row}));
  return legs;
}

class Search {
 public:
  Search(const MotionCost& cost, double most_J)
      : cost_(cost),
        map_(cost.map()),
        grid_(map_.grid()),
        legs_(allLegs()),
        most_J_(most_J),
        cells_(grid_.size()) {
    for (const Leg& leg : legs_) heading_costs_.emplace_back(map_.cost(), leg.heading);
  }

  Polyline between(const Segment& places, double tolerance_m, const StopCheck& stop) {
    begin(places.from);
    std::size_t settled = 0;
    while (!open_.empty()) {
      const auto [so_far_J, at] = open_.top();
      open_.pop();
      if (static_cast<double>(so_far_J) >= most_J_) break;
      if (so_far_J > cells_[at].cost_J) continue;
      if ((++settled & 0xfffU) == 0 && stop()) return {};
      const Cell cell{static_cast<int>(at) % grid_.width, static_cast<int>(at) / grid_.width};
      end(cell, places.to, tolerance_m);
      for (std::size_t k = 0; k < legs_.size(); ++k) follow(cell, so_far_J, k);
    }
    return route(places.from);
  }

 private:
  struct Reached {
    float cost_J = std::numeric_limits<float>::infinity();
    std::uint32_t from = kNoNode;
  };

  void reach(Cell cell, double cost_J, std::uint32_t from) {
    const std::size_t at = grid_.index(cell);
    const auto rounded = static_cast<float>(cost_J);
    if (!(rounded < cells_[at].cost_J) || !(cost_J < most_J_)) return;
    cells_[at] = {rounded, from};
    open_.emplace(rounded, static_cast<std::uint32_t>(at));
  }

  void begin(Point start) {
    for (const Cell cell : cellsWithin(grid_, start, kFar * grid_.resolution_m))
      reach(cell, cost_({start, grid_.centre(cell)}), kNoNode);
  }

  // Ends a route at a settled cell within the tolerance of the goal, or with a last leg from the cell to the
  // goal. Keeps the route if it costs less than the best route so far.
  void end(Cell cell, Point goal, double tolerance_m) {
    const Point here = grid_.centre(cell);
    const double away_m = std::hypot(goal.x_m - here.x_m, goal.y_m - here.y_m);
    if (away_m > std::max(tolerance_m, kFar * grid_.resolution_m)) return;
    const bool there = away_m <= tolerance_m;
    const double through_J =
        static_cast<double>(cells_[grid_.index(cell)].cost_J) + (there ? 0.0 : cost_({here, goal}));
    if (!(through_J < most_J_)) return;
    most_J_ = through_J;
    last_ = static_cast<std::uint32_t>(grid_.index(cell));
    goal_ = there ? here : goal;
  }

  void follow(Cell cell, float so_far_J, std::size_t k) {
    const Leg& leg = legs_[k];
    const Cell to{cell.column + leg.offset.column, cell.row + leg.offset.row};
    if (!grid_.contains(to) || !(so_far_J < cells_[grid_.index(to)].cost_J)) return;
    float metres_J = 0.0F;
    for (const Leg::Crossed& crossed : leg.cells) {
      const float here =
          heading_costs_[k](map_.at({cell.column + crossed.offset.column, cell.row + crossed.offset.row}));
      if (!(here < std::numeric_limits<float>::infinity())) return;
      metres_J += crossed.length * here;
    }
    reach(to, static_cast<double>(so_far_J) + static_cast<double>(metres_J) * grid_.resolution_m,
          static_cast<std::uint32_t>(grid_.index(cell)));
  }

  Polyline route(Point start) const {
    if (last_ == kNoNode) return {};
    return nodeRoute(
        {start, goal_}, last_, [this](std::uint32_t node) { return cells_[node].from; },
        [this](std::uint32_t node) {
          const int at = static_cast<int>(node);
          return grid_.centre({at % grid_.width, at / grid_.width});
        });
  }

  const MotionCost& cost_;
  const costmap::CostGrid& map_;
  const maps::Grid& grid_;
  std::vector<Leg> legs_;
  std::vector<HeadingCost> heading_costs_;
  double most_J_;
  std::vector<Reached> cells_;
  std::priority_queue<std::pair<float, std::uint32_t>, std::vector<std::pair<float, std::uint32_t>>,
                      std::greater<>>
      open_;
  std::uint32_t last_ = kNoNode;
  Point goal_{};
};

}  // namespace

Polyline manyHeadingsRoute(const MotionCost& cost, const Segment& places, double tolerance_m, double most_J,
                           const StopCheck& stop) {
  return Search(cost, most_J).between(places, tolerance_m, stop);
}

}  // namespace talus::planner
