#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <talus/common/common.hpp>
#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {
namespace {

constexpr double kTouch = 1e-6;  // cells: closer coordinates are on the edge; rounding at 1e7 m is 1e-8

// A point in cells from the south-west corner of the map.
struct InCells {
  double x, y;
};

InCells inCells(const maps::Grid& grid, maps::Point p) noexcept {
  return {(p.x_m - grid.south_west.x_m) / grid.resolution_m,
          (p.y_m - grid.south_west.y_m) / grid.resolution_m};
}

// Coordinates cannot overflow when squared; std::hypot would cost as much as five cells.
double lengthOf(InCells delta) noexcept {
  return std::sqrt(delta.x * delta.x + delta.y * delta.y);
}

bool onEdge(double coordinate) noexcept {
  return std::abs(coordinate - std::round(coordinate)) < kTouch;
}

// One axis of the traversal: current cell, and share t of the segment at which the next cell begins.
struct Axis {
  int cell;
  int step;
  double next_t;
  double t_per_cell;

  Axis(double from, double delta) noexcept : step(delta > 0 ? 1 : -1) {
    const double first = onEdge(from) ? std::round(from) - (delta < 0 ? 1 : 0) : std::floor(from);
    const bool moves = std::abs(delta) > kTouch;
    cell = static_cast<int>(moves ? first : std::floor(from));
    t_per_cell = moves ? std::abs(1.0 / delta) : kInfinity;
    next_t = moves ? (first + (delta > 0 ? 1.0 : 0.0) - from) / delta : kInfinity;
  }

  void advance() noexcept {
    cell += step;
    next_t += t_per_cell;
  }
};

bool insideWithBorder(const maps::Grid& grid, InCells p) noexcept {
  return p.x >= 0 && p.y >= 0 && p.x <= grid.width && p.y <= grid.height;
}

// Sum of (share of the segment) * (cost per metre) over the crossed cells.
class Walk {
 public:
  Walk(const costmap::CostGrid& map, const HeadingCost& cost) noexcept : map_(map), cost_(cost) {}

  // `length` is that of delta
  double operator()(InCells from, InCells delta, double length) const noexcept {
    Axis x(from.x, delta.x), y(from.y, delta.y);
    const double corner = kTouch / length;
    double sum = 0.0, t = 0.0;
    for (;;) {
      const double next = std::min({x.next_t, y.next_t, 1.0});
      const double here = costAt({x.cell, y.cell});
      if (here == kInfinity) return kInfinity;
      sum += (next - t) * here;
      if (next >= 1.0 - corner) return sum;
      t = next;
      if (std::abs(x.next_t - y.next_t) <= corner) {
        if (costAt({x.cell + x.step, y.cell}) + costAt({x.cell, y.cell + y.step}) == kInfinity)
          return kInfinity;
        x.advance();
        y.advance();
      } else {
        (x.next_t < y.next_t ? x : y).advance();
      }
    }
  }

 private:
  double costAt(maps::Cell c) const noexcept {
    return map_.grid().contains(c) ? static_cast<double>(cost_(map_.at(c))) : kInfinity;
  }

  const costmap::CostGrid& map_;
  const HeadingCost& cost_;
};

// Returns the cost of a segment on the line between two columns (or rows): that of the more expensive side.
// On the border of the map only one side exists.
double alongEdge(const maps::Grid& grid, const Walk& walk, InCells from, InCells delta,
                 double length) noexcept {
  const bool vertical = std::abs(delta.x) <= kTouch;
  double highest = -1.0;
  for (const double side : {-0.5, 0.5}) {
    InCells shifted = from;
    (vertical ? shifted.x : shifted.y) += side;
    if (insideWithBorder(grid, shifted)) highest = std::max(highest, walk(shifted, delta, length));
  }
  return highest;
}

}  // namespace

MotionCost::MotionCost(std::shared_ptr<const costmap::CostGrid> map) : map_(std::move(map)) {}

double MotionCost::operator()(const Segment& motion) const noexcept {
  const maps::Grid& grid = map_->grid();
  const InCells from = inCells(grid, motion.from), to = inCells(grid, motion.to);
  if (!insideWithBorder(grid, from) || !insideWithBorder(grid, to)) return kInfinity;
  const InCells delta{to.x - from.x, to.y - from.y};
  const double length = lengthOf(delta);
  if (length <= kTouch) return allowed(motion.from) ? 0.0 : kInfinity;
  const HeadingCost cost(map_->cost(), {delta.x / length, delta.y / length});
  const Walk walk(*map_, cost);
  const bool edge =
      (std::abs(delta.x) <= kTouch && onEdge(from.x)) || (std::abs(delta.y) <= kTouch && onEdge(from.y));
  return (edge ? alongEdge(grid, walk, from, delta, length) : walk(from, delta, length)) * length *
         grid.resolution_m;
}

namespace {

// Returns true if every cell at the point permits the heading.
bool touchesOnlyAllowed(const costmap::CostGrid& map, InCells p, costmap::Direction heading) noexcept {
  const double reach = 2 * kTouch;
  for (const double dx : {-reach, reach})
    for (const double dy : {-reach, reach}) {
      const maps::Cell cell{static_cast<int>(std::floor(p.x + dx)), static_cast<int>(std::floor(p.y + dy))};
      if (map.grid().contains(cell) && std::isinf(map.cost().costPerMetre(map.at(cell), heading)))
        return false;
    }
  return true;
}

}  // namespace

bool MotionCost::headingAllowed(maps::Point place, costmap::Direction heading) const noexcept {
  const InCells p = inCells(map_->grid(), place);
  if (onEdge(p.x) || onEdge(p.y)) return touchesOnlyAllowed(*map_, p, heading);
  const auto cell = map_->grid().cellAt(place);
  return cell && std::isfinite(map_->cost().costPerMetre(map_->at(*cell), heading));
}

// A turn on an edge or corner must not pass between blocked cells: all cells at the point must permit both
// headings.
bool MotionCost::turnAllowed(const Segment& motion, maps::Point end) const noexcept {
  const InCells p = inCells(map_->grid(), end);
  if (!onEdge(p.x) && !onEdge(p.y)) return true;
  const double dx = motion.to.x_m - motion.from.x_m, dy = motion.to.y_m - motion.from.y_m;
  const double length = std::hypot(dx, dy);
  return length == 0.0 || touchesOnlyAllowed(*map_, p, {dx / length, dy / length});
}

costmap::Direction directionOf(const Segment& motion) noexcept {
  const double dx = motion.to.x_m - motion.from.x_m, dy = motion.to.y_m - motion.from.y_m;
  const double length = std::sqrt(dx * dx + dy * dy);
  return length > 0.0 ? costmap::Direction{dx / length, dy / length} : costmap::Direction{};
}

double MotionCost::turn(maps::Point place, costmap::Direction from, costmap::Direction to) const noexcept {
  const auto cell = map_->grid().cellAt(place);
  if (!cell) return 0.0;
  const costmap::TravelCost& cost = map_->cost();
  const costmap::CellCode code = map_->at(*cell);
  const double radian_J = cost.turn(code).cost_J;
  if (radian_J == 0.0 && !cost.mayTip(code)) return 0.0;
  constexpr double kApart_rad = 0.02;
  const auto stands = [&](costmap::Direction heading) { return !cost.tips(code, heading); };
  if (cost.mayTip(code) && !holdsBetween(from, to, kApart_rad, stands)) return kInfinity;
  return radian_J * std::abs(turnBetween_rad(from, to));
}

double MotionCost::along(const std::vector<maps::Point>& points) const noexcept {
  double sum = 0.0;
  std::optional<costmap::Direction> before;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Segment motion{points[i - 1], points[i]};
    if (i > 1 && !turnAllowed(motion, motion.from)) return kInfinity;
    if (i + 1 < points.size() && !turnAllowed(motion, motion.to)) return kInfinity;
    sum += (*this)(motion);
    if (motion.from == motion.to) continue;
    const costmap::Direction heading = directionOf(motion);
    if (before) sum += turn(motion.from, *before, heading);
    before = heading;
  }
  return sum;
}

double MotionCost::ofLegs(const std::vector<maps::Point>& points) const noexcept {
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (*this)({points[i - 1], points[i]});
  return sum;
}

bool MotionCost::allowed(maps::Point place) const noexcept {
  const auto cell = map_->grid().cellAt(place);
  if (!cell) return false;
  for (int k = 0; k < 16; ++k) {
    const double angle = k * 0.39269908169872414;  // pi / 8
    if (std::isfinite(map_->cost().costPerMetre(map_->at(*cell), {std::cos(angle), std::sin(angle)})))
      return true;
  }
  return !allowedHeadings(map_->cost(), map_->at(*cell)).empty();
}

std::vector<maps::Cell> cellsWithin(const maps::Grid& grid, maps::Point place, double radius_m) {
  constexpr double kTouch = 2e-6;  // sides: MotionCost treats places this close to a side as on the side
  const double x = (place.x_m - grid.south_west.x_m) / grid.resolution_m;
  const double y = (place.y_m - grid.south_west.y_m) / grid.resolution_m;
  const double reach = radius_m / grid.resolution_m + kTouch;
  std::vector<maps::Cell> cells;
  if (!(std::isfinite(x) && std::isfinite(y))) return cells;
  // Clamps to the map plus one cell, because distant coordinates would overflow an int.
  const auto first = [reach](double at, int count) {
    return static_cast<int>(std::clamp(std::floor(at - reach), 0.0, static_cast<double>(count)));
  };
  const auto last = [reach](double at, int count) {
    return static_cast<int>(std::clamp(std::floor(at + reach), -1.0, count - 1.0));
  };
  for (int row = first(y, grid.height); row <= last(y, grid.height); ++row)
    for (int column = first(x, grid.width); column <= last(x, grid.width); ++column) {
      const double dx = std::max({column - x, x - column - 1.0, 0.0}),
                   dy = std::max({row - y, y - row - 1.0, 0.0});
      if (dx * dx + dy * dy <= reach * reach) cells.push_back({column, row});
    }
  return cells;
}

}  // namespace talus::planner
