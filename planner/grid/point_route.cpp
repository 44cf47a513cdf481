#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include <talus/planner/bound/cheapest_metre.hpp>
#include <talus/planner/grid/node_route.hpp>
#include <talus/planner/grid/point_route.hpp>
#include <talus/planner/refine/edge_crossings.hpp>
#include <talus/planner/refine/settled_vertices.hpp>
#include <talus/planner/route/cells_within.hpp>
#include <talus/planner/route/heading_cost.hpp>

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
  PointSearch(const MotionCost& cost, Fineness fineness, double most_J)
      : cost_(cost),
        map_(cost.map()),
        grid_(map_.grid()),
        most_J_(most_J),
        cheapest_J_(cheapestMetre_J(map_)),
        side_points_(fineness.side),
        inner_points_(fineness.inner * fineness.inner),
        spots_(allSpots(fineness)),
        crossings_(map_.cost(), side_points_),
        inner_(4 * static_cast<std::size_t>(side_points_) * static_cast<std::size_t>(grid_.width + 1) *
               static_cast<std::size_t>(grid_.height + 1)),
        labels_(inner_ + grid_.size() * static_cast<std::size_t>(inner_points_), kNotReached),
        from_(labels_.size(), kNoNode) {
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

  float rest(Point at) const {
    return static_cast<float>(std::max(0.0, distance_m(at, places_.to) - tolerance_m_) * cheapest_J_ * 0.999);
  }
  // Each side point has two nodes: one reached on a heading that both adjacent cells allow, and a "loose"
  // node reached on a heading that only the crossed cell allows. A loose node may only be left on a heading
  // that both cells allow.
  std::uint32_t loose() const { return static_cast<std::uint32_t>(inner_ / 2); }
  std::size_t held(Cell cell) const {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(grid_.width + 1) +
           static_cast<std::size_t>(cell.column);
  }
  std::uint32_t nodeOf(Cell cell, const Spot& spot) const {
    if (spot.side < 0)
      return static_cast<std::uint32_t>(inner_ + grid_.index(cell) * static_cast<std::size_t>(inner_points_) +
                                        static_cast<std::size_t>(spot.number));
    const Cell holder{cell.column + (spot.side == kEastSide ? 1 : 0),
                      cell.row + (spot.side == kNorthSide ? 1 : 0)};
    const std::size_t axis = spot.side >= kSouthSide ? 1 : 0;
    return static_cast<std::uint32_t>((2 * held(holder) + axis) * static_cast<std::size_t>(side_points_) +
                                      static_cast<std::size_t>(spot.number));
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
    if (node >= inner_) {
      const auto k = static_cast<int>(node - inner_), per = inner_points_;
      return {{(k / per) % grid_.width, (k / per) / grid_.width},
              static_cast<std::size_t>(4 * side_points_ + k % per)};
    }
    if (node >= loose()) node -= loose();
    const auto k = static_cast<int>(node) % side_points_, edge = static_cast<int>(node) / side_points_;
    const int holder = edge / 2, side = edge % 2 == 1 ? kSouthSide : kWestSide;
    return {{holder % (grid_.width + 1), holder / (grid_.width + 1)},
            static_cast<std::size_t>(side * side_points_ + k)};
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
    const bool must_share = node >= loose() && node < inner_;
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
  double most_J_, cheapest_J_;
  int side_points_, inner_points_;
  std::vector<Spot> spots_;
  EdgeCrossings crossings_;
  std::vector<std::vector<SpotLeg>> legs_;  // by spot
  std::size_t inner_;                       // first node inside a cell
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
                    const StopCheck& stop) {
  const std::size_t cells = cost.map().grid().size();
  const auto found = [&](Fineness fineness) {
    Polyline way = offSides(cost, PointSearch(cost, fineness, most_J).between(places, tolerance_m, stop));
    return std::isfinite(cost.along(way)) ? way : Polyline{};
  };
  if (cells > kFineCells) return found(kCoarse);
  Polyline way = found(cells > kTinyCells ? kFine : kFinest);
  return way.empty() && cells > kTinyCells && cells <= kFinestCells ? found(kFinest) : way;
}

}  // namespace talus::planner
