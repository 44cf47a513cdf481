#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include <talus/common/common.hpp>
#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

Polyline subdivided(const Polyline& points, double longest_m) {
  Polyline result;
  if (!points.empty()) result.push_back(points.front());
  for (std::size_t i = 1; i < points.size(); ++i) {
    const maps::Point a = points[i - 1];
    const maps::Point b = points[i];
    const int parts = static_cast<int>(std::ceil(distance_m(a, b) / longest_m));
    for (int k = 1; k < parts; ++k) {
      const double t = static_cast<double>(k) / parts;
      result.push_back({a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m)});
    }
    result.push_back(b);
  }
  return result;
}

double length_m(const Polyline& points) noexcept {
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += distance_m(points[i - 1], points[i]);
  return sum;
}

std::vector<Polyline> cutFromEnd(const Polyline& points, double piece_m, double offset_m) {
  double before_m = length_m(points);  // length of the remaining path
  const double shortest_m = piece_m / 2;
  std::vector<Polyline> backwards{{points.back()}};
  double walked_m = 0.0, next_m = offset_m;
  for (std::size_t i = points.size() - 1; i-- > 0;) {
    const maps::Point from = points[i + 1], to = points[i];
    const double leg_m = distance_m(from, to);
    for (; walked_m + leg_m > next_m && before_m - (next_m - walked_m) > shortest_m; next_m += piece_m) {
      const double share = (next_m - walked_m) / leg_m;
      const maps::Point cut{from.x_m + share * (to.x_m - from.x_m), from.y_m + share * (to.y_m - from.y_m)};
      backwards.back().push_back(cut);
      backwards.push_back({cut});
    }
    backwards.back().push_back(to);
    walked_m += leg_m;
    before_m -= leg_m;
  }
  for (Polyline& piece : backwards) std::reverse(piece.begin(), piece.end());
  std::reverse(backwards.begin(), backwards.end());
  return backwards;
}

std::pair<Polyline, Polyline> splitAt(const Polyline& points, double left_m) {
  Polyline behind{points.back()};
  for (std::size_t i = points.size() - 1; i-- > 0; left_m -= distance_m(points[i + 1], points[i])) {
    const maps::Point from = points[i + 1], to = points[i];
    const double leg_m = distance_m(from, to);
    if (left_m >= leg_m && i > 0) {
      behind.push_back(to);
      continue;
    }
    const double share = leg_m > 0.0 ? std::min(left_m / leg_m, 1.0) : 0.0;
    const maps::Point cut{from.x_m + share * (to.x_m - from.x_m), from.y_m + share * (to.y_m - from.y_m)};
    behind.push_back(cut);
    Polyline before(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    before.push_back(cut);
    std::reverse(behind.begin(), behind.end());
    return {before, behind};
  }
  return {points, points};
}

Polyline cutWithin(Polyline points, maps::Point goal, double tolerance_m) {
  if (!(tolerance_m > 0.0) || points.empty()) return points;
  const double reach_m = tolerance_m * (1.0 - 1e-9);  // keeps the end inside despite rounding
  const auto apart_m = [&](maps::Point p) { return std::hypot(p.x_m - goal.x_m, p.y_m - goal.y_m); };
  const auto inside = std::ranges::find_if(points, [&](maps::Point p) { return apart_m(p) <= reach_m; });
  // A leg may also intersect the circle between two points outside it.
  for (auto to = points.begin() + 1; to != points.end() && to <= inside; ++to) {
    const maps::Point from = *(to - 1);
    const double dx = to->x_m - from.x_m, dy = to->y_m - from.y_m, square = dx * dx + dy * dy;
    const double along = (goal.x_m - from.x_m) * dx + (goal.y_m - from.y_m) * dy;
    const double far = apart_m(from);
    const double root = along * along - square * (far * far - reach_m * reach_m);
    if (far <= reach_m || !(square > 0.0) || root < 0.0 || along <= 0.0) continue;
    const double t = (along - std::sqrt(root)) / square;
    if (t > 1.0) continue;
    *to = {from.x_m + t * dx, from.y_m + t * dy};
    points.erase(to + 1, points.end());
    return points;
  }
  if (inside != points.end()) points.erase(inside + 1, points.end());
  return points;
}

void append(Polyline& points, const Polyline& piece) {
  for (const maps::Point p : piece)
    if (points.empty() || !(points.back() == p)) points.push_back(p);
}

namespace {

std::uint64_t hashOf(maps::Point p) noexcept {
  std::uint64_t hash = std::bit_cast<std::uint64_t>(p.x_m) * 0x9e3779b97f4a7c15U;
  hash = (hash ^ (hash >> 32)) + std::bit_cast<std::uint64_t>(p.y_m);
  hash *= 0xbf58476d1ce4e5b9U;
  return hash ^ (hash >> 29);
}

}  // namespace

std::vector<Polyline> cutAtMarks(const Polyline& points, double apart_m) {
  std::vector<double> at_m(points.size(), 0.0);
  std::vector<std::uint64_t> hash(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    hash[i] = hashOf(points[i]);
    if (i > 0)
      at_m[i] =
          at_m[i - 1] + std::hypot(points[i].x_m - points[i - 1].x_m, points[i].y_m - points[i - 1].y_m);
  }
  const auto isMark = [&](std::size_t i) {
    for (std::size_t k = i; k-- > 0 && at_m[i] - at_m[k] <= apart_m;)
      if (hash[k] <= hash[i]) return false;
    for (std::size_t k = i + 1; k < points.size() && at_m[k] - at_m[i] <= apart_m; ++k)
      if (hash[k] <= hash[i]) return false;
    return true;
  };
  std::vector<Polyline> pieces(1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    pieces.back().push_back(points[i]);
    if (i > 0 && i + 1 < points.size() && isMark(i)) pieces.push_back({points[i]});
  }
  return pieces;
}

namespace {

constexpr double kTouch = 1e-6;  // cells: closer coordinates are on the edge; rounding at 1e7 m is 1e-8
// Cells: turns closer to an edge touch both cells, and motions closer to a corner touch all four. The check
// (route_check) treats distances up to 2e-6 so.
constexpr double kClose = 1e-5;

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

bool onEdge(double coordinate, double within = kTouch) noexcept {
  return std::abs(coordinate - std::round(coordinate)) < within;
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
      } else if (x.next_t < y.next_t) {
        const int close = beside(from.y + t * delta.y, y.cell);
        if (close != y.cell && (closed({x.cell, close}) || closed({x.cell + x.step, close})))
          return kInfinity;
        x.advance();
      } else {
        const int close = beside(from.x + t * delta.x, x.cell);
        if (close != x.cell && (closed({close, y.cell}) || closed({close, y.cell + y.step})))
          return kInfinity;
        y.advance();
      }
    }
  }

 private:
  // The row or column beyond the edge that is close to a coordinate in `cell`; `cell` if none is.
  static int beside(double coordinate, int cell) noexcept {
    const double inside = coordinate - cell;
    return inside < kClose ? cell - 1 : inside > 1.0 - kClose ? cell + 1 : cell;
  }
  bool closed(maps::Cell c) const noexcept {
    return map_.grid().contains(c) && static_cast<double>(cost_(map_.at(c))) == kInfinity;
  }
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
  for (const double dx : {-kClose, kClose})
    for (const double dy : {-kClose, kClose}) {
      const maps::Cell cell{static_cast<int>(std::floor(p.x + dx)), static_cast<int>(std::floor(p.y + dy))};
      if (map.grid().contains(cell) && std::isinf(map.cost().costPerMetre(map.at(cell), heading)))
        return false;
    }
  return true;
}

}  // namespace

bool MotionCost::headingAllowed(maps::Point place, costmap::Direction heading) const noexcept {
  const InCells p = inCells(map_->grid(), place);
  if (onEdge(p.x, kClose) || onEdge(p.y, kClose)) return touchesOnlyAllowed(*map_, p, heading);
  const auto cell = map_->grid().cellAt(place);
  return cell && std::isfinite(map_->cost().costPerMetre(map_->at(*cell), heading));
}

// A turn on an edge or corner must not pass between blocked cells: all cells at the point must permit both
// headings.
bool MotionCost::turnAllowed(const Segment& motion, maps::Point end) const noexcept {
  const InCells p = inCells(map_->grid(), end);
  if (!onEdge(p.x, kClose) && !onEdge(p.y, kClose)) return true;
  const double dx = motion.to.x_m - motion.from.x_m, dy = motion.to.y_m - motion.from.y_m;
  const double length = lengthOf({dx, dy});
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
  const double radian_J = cost.cost_J(cost.turn(code));
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
