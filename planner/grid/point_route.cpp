#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/grid/point_route.hpp>
#include <talus/planner/refine/corridor_search.hpp>
#include <talus/planner/refine/vertices.hpp>
#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {
namespace {

using costmap::CellCode;
using maps::Cell;
using maps::Point;

// Number of points on each side of a cell, and in each row and column of points inside a cell. kCoarse above
// kFineCells cells, kFinest up to kTinyCells, kFine between; if kFine finds no route on a map of up to
// kFinestCells, kFinest is tried.
struct Fineness {
  int side, inner;
};
constexpr Fineness kFinest{15, 5}, kFine{7, 3}, kCoarse{3, 1};
constexpr std::size_t kTinyCells = 1'000, kFinestCells = 5'000, kFineCells = 20'000;

constexpr std::size_t kMostTaken = 2'000'000;  // points
constexpr float kNotReached = std::numeric_limits<float>::infinity();

// A point of a cell: on a side (0 to 3) or inside (side -1).
struct Spot {
  int side, number;
  double x, y;
};

std::vector<Spot> allSpots(Fineness fineness) {
  std::vector<Spot> spots;
  for (int side = 0; side < 4; ++side)
    for (int k = 0; k < fineness.side; ++k) {
      const EdgeSpot at = edgeSpot(side, k, fineness.side);
      spots.push_back({side, k, at.x, at.y});
    }
  const int inner = fineness.inner;
  for (int k = 0; k < inner * inner; ++k) {
    const int row = k / inner, column = k % inner;
    spots.push_back({-1, k, (column + 0.5) / inner, (row + 0.5) / inner});
  }
  return spots;
}

// A straight leg between two spots of a cell.
struct SpotLeg {
  std::size_t to;
  float length;  // cell sides
  costmap::Direction heading;
  HeadingCost cost;
};

class PointSearch {
 public:
  PointSearch(const MotionCost& cost, Fineness fineness, double most_J, const Rest& rest)
      : cost_(cost),
        map_(cost.map()),
        grid_(map_.grid()),
        most_J_(most_J),
        rest_of_(rest),
        side_points_(fineness.side),
        inner_points_(fineness.inner * fineness.inner),
        spots_(allSpots(fineness)),
        crossings_(map_.cost(), side_points_),
        per_cell_(4 * side_points_ + inner_points_),
        slot_of_(static_cast<std::size_t>(grid_.width + 1) * static_cast<std::size_t>(grid_.height + 1),
                 kNoNode) {
    for (const Spot& from : spots_) addLegs(from);
  }

  Polyline between(const Segment& places, double tolerance_m, const StopCheck& stop) {
    places_ = places;
    tolerance_m_ = tolerance_m;
    for (const Cell cell : cellsWithin(grid_, places.from, 0.0))
      for (const Spot& spot : spots_) {
        if (!insideMap(cell, spot)) continue;
        const Segment leg{places.from, placeOf(cell, spot)};
        const bool strict = spot.side < 0 || cost_.turnAllowed(leg, leg.to);
        reach(nodeOf(cell, spot) + (strict ? 0 : loose()), cost_(leg), kNoNode, leg.to);
      }
    std::size_t taken = 0;
    while (!open_.empty()) {
      const auto [least, node] = open_.top();
      open_.pop();
      if (static_cast<double>(least) >= most_J_) break;
      if (least > labels_[node] + rest(place(node))) continue;
      if ((++taken & 0xfffU) == 0 && stop()) return {};
      if (taken > kMostTaken) break;
      expand(node);
    }
    return route();
  }

 private:
  void addLegs(const Spot& from) {
    std::vector<SpotLeg>& legs = legs_.emplace_back();
    for (std::size_t to = 0; to < spots_.size(); ++to) {
      const double dx = spots_[to].x - from.x, dy = spots_[to].y - from.y, length = std::hypot(dx, dy);
      if (length == 0.0 || (from.side >= 0 && from.side == spots_[to].side)) continue;
      const costmap::Direction heading{dx / length, dy / length};
      legs.push_back({to, static_cast<float>(length), heading, HeadingCost(map_.cost(), heading)});
    }
  }

  float rest(Point at) const { return static_cast<float>(rest_of_(at)); }
  // Each side point has two nodes: one reached on a heading that both adjacent cells allow, and a "loose"
  // node reached on a heading that only the crossed cell allows. A loose node may only be left on a heading
  // that both cells allow.
  std::uint32_t loose() const { return static_cast<std::uint32_t>(2 * side_points_); }
  bool isLoose(std::uint32_t node) const {
    const int k = static_cast<int>(node % static_cast<std::uint32_t>(per_cell_));
    return k >= 2 * side_points_ && k < 4 * side_points_;
  }
  // The nodes of a cell: those of its west and south side, the same loose, and those inside. They are created when
  // one of them is asked for.
  std::uint32_t nodeOf(Cell cell, const Spot& spot) {
    if (spot.side == kEastSide) ++cell.column;
    if (spot.side == kNorthSide) ++cell.row;
    std::uint32_t& slot =
        slot_of_[static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(grid_.width + 1) +
                 static_cast<std::size_t>(cell.column)];
    if (slot == kNoNode) {
      slot = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back(cell);
      labels_.resize(cells_.size() * static_cast<std::size_t>(per_cell_), kNotReached);
      from_.resize(labels_.size(), kNoNode);
    }
    const int first = spot.side < 0 ? 4 * side_points_ : spot.side >= kSouthSide ? side_points_ : 0;
    return slot * static_cast<std::uint32_t>(per_cell_) + static_cast<std::uint32_t>(first + spot.number);
  }
  bool insideMap(Cell cell, const Spot& spot) const {
    return spot.side < 0 || grid_.contains(beyond(cell, spot.side));
  }
  static Cell beyond(Cell cell, int side) {
    return {cell.column + (side == kEastSide   ? 1
                           : side == kWestSide ? -1
                                               : 0),
            cell.row + (side == kNorthSide   ? 1
                        : side == kSouthSide ? -1
                                             : 0)};
  }
  Point placeOf(Cell cell, const Spot& spot) const {
    return {grid_.south_west.x_m + (cell.column + spot.x) * grid_.resolution_m,
            grid_.south_west.y_m + (cell.row + spot.y) * grid_.resolution_m};
  }
  // Returns the cell of a node and the index of the node's point in spots_. A point on a side belongs to two
  // cells; the cell east or north of the side is returned.
  std::pair<Cell, std::size_t> whereIs(std::uint32_t node) const {
    const Cell cell = cells_[node / static_cast<std::uint32_t>(per_cell_)];
    const int k = static_cast<int>(node % static_cast<std::uint32_t>(per_cell_)), side = 2 * side_points_;
    if (k >= 2 * side) return {cell, static_cast<std::size_t>(k)};
    const int west_or_south = k % side < side_points_ ? kWestSide : kSouthSide;
    return {cell, static_cast<std::size_t>(west_or_south * side_points_ + k % side_points_)};
  }
  Point place(std::uint32_t node) const {
    const auto [cell, spot] = whereIs(node);
    return placeOf(cell, spots_[spot]);
  }

  void reach(std::uint32_t node, double cost_J, std::uint32_t from, Point at) {
    const auto rounded = static_cast<float>(cost_J);
    if (!(rounded < labels_[node])) return;
    const float least = rounded + rest(at);
    if (!(static_cast<double>(least) < most_J_)) return;
    labels_[node] = rounded;
    from_[node] = from;
    open_.emplace(least, node);
  }

  void expand(std::uint32_t node) {
    const auto [cell, spot] = whereIs(node);
    const Point here = placeOf(cell, spots_[spot]);
    const Point before = from_[node] == kNoNode ? places_.from : place(from_[node]);
    const costmap::Direction heading = directionOf({before, here});
    end(node, here, heading);
    if (spots_[spot].side < 0) return cross(node, cell, spot, heading);
    if (grid_.contains(cell)) cross(node, cell, spot, heading);
    const Cell other = beyond(cell, spots_[spot].side);
    if (grid_.contains(other)) cross(node, other, spot + static_cast<std::size_t>(side_points_), heading);
  }

  void end(std::uint32_t node, Point here, costmap::Direction heading) {
    const double away_m = distance_m(here, places_.to);
    if (away_m > std::max(tolerance_m_, 1.5 * grid_.resolution_m)) return;
    double cost_J = static_cast<double>(labels_[node]);
    const bool there = away_m <= tolerance_m_;
    const Segment leg{here, places_.to};
    if (!there && away_m > 0.0) {
      if (!cost_.turnAllowed(leg, here)) return;
      cost_J += cost_(leg) + cost_.turn(here, heading, directionOf(leg));
    }
    if (!(cost_J < most_J_)) return;
    most_J_ = cost_J;
    last_ = node;
    goal_ = there ? here : places_.to;
  }

  void cross(std::uint32_t node, Cell cell, std::size_t spot, costmap::Direction heading) {
    const CellCode code = map_.at(cell);
    if (code.curve() >= map_.cost().curves().size()) return;
    const bool free = crossings_.free(code);
    const double turn_J = map_.cost().turn(code).cost_J;
    const float label = labels_[node];
    const bool must_share = isLoose(node);
    for (const SpotLeg& leg : legs_[spot]) {
      const Spot& to = spots_[leg.to];
      if (to.side < 0 ? free : !grid_.contains(beyond(cell, to.side))) continue;
      std::uint32_t next = nodeOf(cell, to);
      if (!(label < labels_[next]) && (to.side < 0 || !(label < labels_[next + loose()]))) continue;
      const float price = leg.cost(code);
      if (!(price < kNotReached)) continue;
      double through =
          static_cast<double>(label) + static_cast<double>(price * leg.length) * grid_.resolution_m;
      const float most = to.side < 0 ? labels_[next] : std::max(labels_[next], labels_[next + loose()]);
      if (!(static_cast<float>(through) < most)) continue;
      if (turn_J > 0.0)
        through +=
            turn_J * std::acos(std::clamp(leg.heading.x * heading.x + leg.heading.y * heading.y, -1.0, 1.0));
      if (must_share && !mayLeave(cell, spots_[spot].side, leg)) continue;
      if (to.side >= 0 && !mayLeave(cell, to.side, leg)) next += loose();
      reach(next, through, node, placeOf(cell, to));
    }
  }

  // A turn on a side touches both adjacent cells, so both must allow the heading.
  bool mayLeave(Cell cell, int side, const SpotLeg& leg) const {
    if (side < 0) return true;
    const Cell other = beyond(cell, side);
    return !grid_.contains(other) || leg.cost(map_.at(other)) < kNotReached;
  }

  Polyline route() const {
    if (last_ == kNoNode) return {};
    return nodeRoute(
        {places_.from, goal_}, last_, [this](std::uint32_t node) { return from_[node]; },
        [this](std::uint32_t node) { return place(node); });
  }

  const MotionCost& cost_;
  const costmap::CostGrid& map_;
  const maps::Grid& grid_;
  double most_J_;
  const Rest& rest_of_;
  int side_points_, inner_points_;
  std::vector<Spot> spots_;
  EdgeCrossings crossings_;
  std::vector<std::vector<SpotLeg>> legs_;  // by spot
  int per_cell_;                            // nodes
  std::vector<std::uint32_t> slot_of_;      // by cell, with a column and a row beyond the map
  std::vector<Cell> cells_;                 // by slot
  std::vector<float> labels_;
  std::vector<std::uint32_t> from_;
  std::priority_queue<std::pair<float, std::uint32_t>, std::vector<std::pair<float, std::uint32_t>>,
                      std::greater<>>
      open_;
  Segment places_{};
  double tolerance_m_ = 0.0;
  std::uint32_t last_ = kNoNode;
  Point goal_{};
};

}  // namespace

Polyline pointRoute(const MotionCost& cost, const Segment& places, double tolerance_m, double most_J,
                    const StopCheck& stop, const Rest& rest) {
  const std::size_t cells = cost.map().grid().size();
  const double metre_J = 0.999 * cheapestMetre_J(cost.map());
  const Rest straight = [&](Point at) {
    return std::max(0.0, distance_m(at, places.to) - tolerance_m) * metre_J;
  };
  const auto found = [&](Fineness fineness) {
    Polyline way = offSides(
        cost, PointSearch(cost, fineness, most_J, rest ? rest : straight).between(places, tolerance_m, stop));
    return std::isfinite(cost.along(way)) ? way : Polyline{};
  };
  if (cells > kFineCells) return found(kCoarse);
  Polyline way = found(cells > kTinyCells ? kFine : kFinest);
  return way.empty() && cells > kTinyCells && cells <= kFinestCells ? found(kFinest) : way;
}

}  // namespace talus::planner
