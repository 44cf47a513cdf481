#include <optional>
#include <queue>

#include <talus/planner/reach/cell_route.hpp>
#include <talus/planner/reach/cell_side.hpp>
#include <talus/planner/reach/reach.hpp>

namespace talus::planner {
namespace {

using maps::Cell;
using maps::Point;

constexpr double kInside_rad = 1e-3;  // headings are taken so far from the end of their arc, or in its middle
constexpr double kApart = 1e-3;       // sides: crossings keep so far from corners
constexpr int kWays = 4;              // parts of one side that are followed
constexpr int kMostLegs = 512;        // of a zigzag within one cell

// A part of a side of a cell where a way comes in; of the first node the start itself.
struct Node {
  Cell cell;
  int side = -1;
  SideRange range{};
  double heading_rad = 0.0;  // of the crossing
  int parent = -1;
};

InCell operator+(InCell a, InCell b) noexcept {
  return {a.x + b.x, a.y + b.y};
}
InCell operator-(InCell a, InCell b) noexcept {
  return {a.x - b.x, a.y - b.y};
}
InCell operator*(double s, InCell a) noexcept {
  return {s * a.x, s * a.y};
}
InCell unit(double heading_rad) noexcept {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}
bool inside(InCell p) noexcept {
  return p.x >= 1e-4 && p.x <= 1.0 - 1e-4 && p.y >= 1e-4 && p.y <= 1.0 - 1e-4;
}

// The share of a unit step that stays well inside a cell.
double stepInside(InCell from, InCell step) noexcept {
  const auto room = [](double at, double by) {
    return by > 0.0 ? (1.0 - at) / by : by < 0.0 ? -at / by : 1.0;
  };
  return 0.4 * std::min(room(from.x, step.x), room(from.y, step.y));
}

// From p to q within one cell by headings of a set; false where that takes more legs than allowed.
bool connect(const HeadingSet& set, InCell p, InCell q, std::vector<InCell>& way) {
  const InCell d = q - p;
  const double heading = std::atan2(d.y, d.x), length = std::hypot(d.x, d.y);
  if (length < 1e-9) return true;
  const double before = set.nearest(heading, kInside_rad);
  if (std::abs(std::remainder(before - heading, HeadingSet::kTurn)) * length < 1e-9) {
    way.push_back(q);
    return true;
  }
  // The arcs on both sides of the heading; a, b >= 0 metres along each add up to it.
  double right = -HeadingSet::kTurn, left = HeadingSet::kTurn;
  for (const HeadingArc& arc : set.arcs()) {
    const double in = std::min(kInside_rad, 0.5 * arc.width_rad);
    for (const double at : {arc.from_rad + in, arc.from_rad + arc.width_rad - in}) {
      double off = std::fmod(at - heading, HeadingSet::kTurn);
      if (off < 0.0) off += HeadingSet::kTurn;
      left = std::min(left, off);
      right = std::max(right, off - HeadingSet::kTurn);
    }
  }
  const double between = std::sin(left - right);
  if (!(left - right < 0.5 * HeadingSet::kTurn) || !(between > 0.0)) return false;
  const InCell u = length * std::sin(left) / between * unit(heading + right);
  const InCell v = length * std::sin(-right) / between * unit(heading + left);
  for (int legs = 1; legs <= kMostLegs; legs *= 2) {
    const double part = 1.0 / legs;
    for (const InCell& first : {u, v}) {
      if (!inside(p + part * first) || !inside(p + (1.0 - part) * d + part * first)) continue;
      for (int k = 0; k < legs; ++k) {
        way.push_back(p + k * part * d + part * first);
        way.push_back(p + (k + 1) * part * d);
      }
      return true;
    }
  }
  return false;
}

// Where a route passes from one cell into the next.
struct Crossing {
  Cell cell;     // behind it
  InCell place;  // in that cell
  double heading_rad;
  int side;
};

class Search {
 public:
  Search(const MotionCost& cost, HeadingSets& headings, const Segment& places, double tolerance_m,
         const CellRouteLimits& limits)
      : cost_(cost),
        map_(cost.map()),
        headings_(headings),
        places_(places),
        tolerance_m_(tolerance_m),
        limits_(limits),
        passed_(map_.grid().size(), false) {}

  CellRoute route(const StopCheck& stop) {
    CellRoute found;
    for (const Cell cell : cellsWithin(map_.grid(), places_.from, 0.0)) open({.cell = cell}, 0.0);
    while (!queue_.empty()) {
      const auto [spent, k] = queue_.top();
      queue_.pop();
      const Node node = nodes_[static_cast<std::size_t>(k)];
      if (closed(node)) continue;
      if (found.ways == limits_.ways || ((found.ways & 0xfffU) == 0 && stop())) return found;
      ++found.ways;
      if (const auto end = endIn(node))
        if (found.points = laid(k, *end); !found.points.empty()) return found;
      expand(k, -spent);
    }
    found.all_ways = true;
    return found;
  }

 private:
  InCell inCell(Cell cell, Point p) const noexcept {
    const maps::Grid& grid = map_.grid();
    return {(p.x_m - grid.south_west.x_m) / grid.resolution_m - cell.column,
            (p.y_m - grid.south_west.y_m) / grid.resolution_m - cell.row};
  }
  Point onMap(Cell cell, InCell p) const noexcept {
    const maps::Grid& grid = map_.grid();
    return {grid.south_west.x_m + (cell.column + p.x) * grid.resolution_m,
            grid.south_west.y_m + (cell.row + p.y) * grid.resolution_m};
  }

  void open(const Node& node, double spent) {
    nodes_.push_back(node);
    queue_.emplace(-spent, static_cast<int>(nodes_.size()) - 1);
  }

  // Whether the way adds nothing to those that were here before; else it counts as having been. Ground that is free to
  // go everywhere is passed once.
  bool closed(const Node& node) {
    const std::size_t cell = map_.grid().index(node.cell);
    if (passed_[cell]) return true;
    if (DriveCone(headings_.of(map_.at(node.cell))).everywhere()) {
      passed_[cell] = true;
      return false;
    }
    auto& known = closed_[cell];
    int same = 0;
    for (const auto& [side, range] : known) {
      if (side == node.side && range.holds(node.range)) return true;
      same += side == node.side ? 1 : 0;
    }
    if (same >= kWays) return true;
    known.emplace_back(node.side, node.range);
    return false;
  }

  std::pair<InCell, InCell> ends(const Node& node) const noexcept {
    if (node.side < 0) return {inCell(node.cell, places_.from), inCell(node.cell, places_.from)};
    return {onSide(node.side, node.range.from), onSide(node.side, node.range.to)};
  }

  // Where a way that came in here may end.
  std::optional<InCell> endIn(const Node& node) const {
    InCell goal = inCell(node.cell, places_.to);
    if (tolerance_m_ > 0.0) goal = {std::clamp(goal.x, 0.05, 0.95), std::clamp(goal.y, 0.05, 0.95)};
    const Point place = onMap(node.cell, goal);
    const double off_m = std::hypot(place.x_m - places_.to.x_m, place.y_m - places_.to.y_m);
    if (off_m > std::max(tolerance_m_, 1e-6 * map_.grid().resolution_m)) return std::nullopt;
    if (goal.x < -1e-6 || goal.x > 1.0 + 1e-6 || goal.y < -1e-6 || goal.y > 1.0 + 1e-6) return std::nullopt;
    const auto [a, b] = ends(node);
    if (!DriveCone(headings_.of(map_.at(node.cell))).joins(a, b, goal, 1e-9)) return std::nullopt;
    return goal;
  }

  // The heading of both sets nearest to straight out of the side; straight back where they share none.
  static double crossing(const HeadingSet& own, const HeadingSet& other, int side) {
    const HeadingSet both = own.shared(other);
    return both.empty() ? outwards_rad(otherSide(side)) : both.nearest(outwards_rad(side), kInside_rad);
  }

  void expand(int k, double spent) {
    const Node node = nodes_[static_cast<std::size_t>(k)];
    const HeadingSet& own = headings_.of(map_.at(node.cell));
    if (own.empty()) return;
    const DriveCone cone(own);
    const auto [a, b] = ends(node);
    const InCell middle = 0.5 * (a + b);
    for (int side = 0; side < 4; ++side) {
      const Cell next = beyond(node.cell, side);
      if (!map_.grid().contains(next) || passed_[map_.grid().index(next)]) continue;
      if (limits_.worth && !limits_.worth(next)) continue;
      const HeadingSet& other = headings_.of(map_.at(next));
      if (other.empty()) continue;
      const double heading = own.all() && other.all() ? outwards_rad(side) : crossing(own, other, side);
      if (!(std::cos(heading - outwards_rad(side)) > 1e-3)) continue;
      SideRange range = cone.reached(a, b, side, -1e-6);
      range = {std::max(range.from, kApart), std::min(range.to, 1.0 - kApart)};
      if (range.empty()) continue;
      const InCell out = onSide(side, 0.5 * (range.from + range.to)), leg = out - middle;
      const InCell h = unit(heading);
      const double metres = map_.grid().resolution_m * std::max(0.05, std::hypot(leg.x, leg.y));
      const double price = map_.cost().costPerMetre(map_.at(node.cell), {h.x, h.y});
      if (std::isfinite(price)) open({next, otherSide(side), range, heading, k}, spent + metres * price);
    }
  }

  // Backwards from the end of the way: where each side is crossed; then the drive through each cell.
  Polyline laid(int last, InCell end) {
    std::vector<Crossing> crossings;
    InCell target = end;
    int k = last;
    for (; nodes_[static_cast<std::size_t>(k)].parent >= 0; k = nodes_[static_cast<std::size_t>(k)].parent) {
      const Node& node = nodes_[static_cast<std::size_t>(k)];
      const DriveCone cone(headings_.of(map_.at(node.cell)));
      SideRange range = cone.reaching(target, node.side, 1e-9);
      range = {std::max(range.from, node.range.from), std::min(range.to, node.range.to)};
      if (range.empty()) return {};
      const double wanted = node.side == Side::West || node.side == Side::East ? target.y : target.x;
      const double inner = 0.25 * (range.to - range.from);
      const double at = cone.everywhere() ? std::clamp(wanted, range.from + inner, range.to - inner)
                                          : 0.5 * (range.from + range.to);
      crossings.push_back({node.cell, onSide(node.side, at), node.heading_rad, node.side});
      target = onSide(otherSide(node.side), at);
    }
    // Sides are crossed on short straight legs; the shorter, the less room they take of a narrow cone.
    for (const double step : {0.2, 0.02, 0.002})
      if (Polyline way = driven(nodes_[static_cast<std::size_t>(k)].cell, crossings, end, step); !way.empty())
        return way;
    return {};
  }

  // The start's cell, and the crossings with the last one first.
  Polyline driven(Cell cell, const std::vector<Crossing>& crossings, InCell end, double step) {
    InCell here = inCell(cell, places_.from);
    Polyline way{places_.from};
    const auto drive = [&](InCell to) {
      std::vector<InCell> places;
      if (!connect(headings_.of(map_.at(cell)), here, to, places)) return false;
      for (const InCell& p : places) way.push_back(onMap(cell, p));
      return true;
    };
    for (auto crossing = crossings.rbegin(); crossing != crossings.rend(); ++crossing) {
      const bool meridian = crossing->side == Side::West || crossing->side == Side::East;
      const InCell h = unit(crossing->heading_rad),
                   out = onSide(otherSide(crossing->side), meridian ? crossing->place.y : crossing->place.x);
      if (!drive(out - std::min(step, stepInside(out, -1.0 * h)) * h)) return {};
      cell = crossing->cell;
      here = crossing->place + std::min(step, stepInside(crossing->place, h)) * h;
      way.push_back(onMap(cell, here));
    }
    if (!drive(end)) return {};
    if (tolerance_m_ == 0.0) way.back() = places_.to;
    return std::isfinite(cost_.along(way)) ? way : Polyline{};
  }

  const MotionCost& cost_;
  const costmap::CostGrid& map_;
  HeadingSets& headings_;
  Segment places_;
  double tolerance_m_;
  const CellRouteLimits& limits_;
  std::vector<bool> passed_;
  std::vector<Node> nodes_;
  std::priority_queue<std::pair<double, int>> queue_;
  std::unordered_map<std::size_t, std::vector<std::pair<int, SideRange>>> closed_;
};

}  // namespace

CellRoute cellRoute(const MotionCost& cost, HeadingSets& headings, const Segment& places, double tolerance_m,
                    const CellRouteLimits& limits, const StopCheck& stop) {
  if (std::isfinite(cost(places))) return {.points = {places.from, places.to}};
  return Search(cost, headings, places, tolerance_m, limits).route(stop);
}

}  // namespace talus::planner
