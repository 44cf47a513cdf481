#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include <planner/corridor_search.hpp>
#include <planner/edge_crossings.hpp>

namespace talus::planner {
namespace {

using costmap::CellCode;
using maps::Cell;
using maps::Point;

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

class Search {
 public:
  Search(const MotionCost& cost, const std::vector<Point>& along, const CorridorOptions& options)
      : cost_(cost),
        grid_(cost.map().grid()),
        points_(options.points_per_edge),
        crossings_(cost.map().cost(), options.points_per_edge, options.kernels),
        paid_(static_cast<std::size_t>(crossings_.count() + EdgeCrossings::kVector)) {
    open(along, options.reach_cells);
  }

  EdgePath run(Point from, Point to, double below_J);

 private:
  // A point of a local cell's edge, and the cell beyond it.
  struct EdgePoint {
    std::uint32_t node;
    std::size_t cell, beyond;
  };

  void open(const std::vector<Point>& along, int reach);
  double priceOfEnd(const Segment& motion, EdgePoint turn) const noexcept;
  std::size_t local(Cell c) const noexcept {
    return static_cast<std::size_t>(c.row - first_.row) * columns_ +
           static_cast<std::size_t>(c.column - first_.column);
  }
  std::uint32_t node(std::size_t cell, int side, int k) const noexcept {
    const std::size_t holder = cell + (side == kEastSide ? 1 : side == kNorthSide ? columns_ : 0);
    return static_cast<std::uint32_t>((2 * holder + (side >= kSouthSide ? 1 : 0)) *
                                      static_cast<std::size_t>(points_)) +
           static_cast<std::uint32_t>(k);
  }
  std::size_t beyond(std::size_t cell, int side) const noexcept {
    return side == kWestSide    ? cell - 1
           : side == kEastSide  ? cell + 1
           : side == kSouthSide ? cell - columns_
                                : cell + columns_;
  }
  bool turnsAllowed(std::size_t cell, int side, EdgeCrossings::End end, int i, int k) const noexcept;
  Cell cellOf(std::size_t local) const noexcept {
    return {first_.column + static_cast<int>(local % columns_),
            first_.row + static_cast<int>(local / columns_)};
  }
  EdgeSpot spotOfNode(std::uint32_t node) const noexcept;
  template <typename Each>
  void forEachEdgePoint(Point place, Each each) const;
  void reach(std::uint32_t node, float label, std::uint32_t from, std::uint32_t cell);
  void settle(std::uint32_t node);
  void cross(std::uint32_t node, std::size_t cell, int side, int k);
  std::size_t bucketOf(float label) const noexcept { return static_cast<std::size_t>(label * per_bucket_); }

  const MotionCost& cost_;
  const maps::Grid& grid_;
  int points_;
  EdgeCrossings crossings_;
  std::vector<float> paid_;
  Cell first_{};  // of the box, two cells of margin around: an end on an edge touches the next cell
  std::size_t columns_ = 0;  // of the box
  std::vector<CellCode> codes_;
  std::vector<bool> free_;                // by local cell: every heading may be had
  std::vector<float> label_, last_;       // by node: cost from the start; on to the end
  std::vector<std::uint32_t> from_, in_;  // node before (kNone: the start); local cell crossed
  std::vector<std::vector<std::uint32_t>> ring_;
  std::size_t queued_ = 0;
  float per_bucket_ = 1.0F;
  float below_ = kFar;
};

// Copies the cells within reach of the way; all others stay unknown, which nothing may enter.
void Search::open(const std::vector<Point>& along, int reach) {
  Cell low{grid_.width, grid_.height}, high{-1, -1};
  std::vector<Cell> on;
  const auto add = [&](double x, double y) {
    const Cell c{std::clamp(static_cast<int>(x), 0, grid_.width - 1),
                 std::clamp(static_cast<int>(y), 0, grid_.height - 1)};
    if (!on.empty() && on.back() == c) return;
    on.push_back(c);
    low = {std::min(low.column, c.column), std::min(low.row, c.row)};
    high = {std::max(high.column, c.column), std::max(high.row, c.row)};
  };
  const auto inCells = [&](Point p) {
    return EdgeSpot{(p.x_m - grid_.south_west.x_m) / grid_.resolution_m,
                    (p.y_m - grid_.south_west.y_m) / grid_.resolution_m};
  };
  EdgeSpot before = inCells(along.front());
  for (const Point p : along) {
    const EdgeSpot here = inCells(p);
    const int steps =
        1 + static_cast<int>(std::max(std::abs(here.x - before.x), std::abs(here.y - before.y)));
    for (int k = 1; k <= steps; ++k)
      add(before.x + (here.x - before.x) * k / steps, before.y + (here.y - before.y) * k / steps);
    before = here;
  }
  first_ = {low.column - reach - 2, low.row - reach - 2};
  columns_ = static_cast<std::size_t>(high.column - low.column + 2 * reach + 5);
  const std::size_t rows = static_cast<std::size_t>(high.row - low.row + 2 * reach + 5);
  codes_.assign(columns_ * rows, CellCode());
  free_.assign(codes_.size(), false);
  std::vector<bool> done(codes_.size());
  for (const Cell c : on) {
    for (int row = std::max(c.row - reach, 0); row <= std::min(c.row + reach, grid_.height - 1); ++row)
      for (int column = std::max(c.column - reach, 0); column <= std::min(c.column + reach, grid_.width - 1);
           ++column) {
        const std::size_t at = local({column, row});
        if (done[at]) continue;
        done[at] = true;
        codes_[at] = cost_.map().at({column, row});
        free_[at] = crossings_.free(codes_[at]);
      }
  }
  const std::size_t nodes = codes_.size() * 2 * static_cast<std::size_t>(points_);
  label_.assign(nodes, kFar);
  last_.assign(nodes, kFar);
  from_.assign(nodes, kNone);
  in_.assign(nodes, kNone);
}

EdgeSpot Search::spotOfNode(std::uint32_t node) const noexcept {
  const auto points = static_cast<std::uint32_t>(points_);
  const Cell c = cellOf(node / points / 2);
  const EdgeSpot in =
      edgeSpot(node / points % 2 == 0 ? kWestSide : kSouthSide, static_cast<int>(node % points), points_);
  return {c.column + in.x, c.row + in.y};
}

// Calls each(where, point) for the edge points of every cell that the place touches.
template <typename Each>
void Search::forEachEdgePoint(Point place, Each each) const {
  const double x = (place.x_m - grid_.south_west.x_m) / grid_.resolution_m,
               y = (place.y_m - grid_.south_west.y_m) / grid_.resolution_m;
  constexpr double kTouch = 1e-6;
  for (int row = static_cast<int>(std::floor(y - kTouch)); row <= static_cast<int>(std::floor(y + kTouch));
       ++row)
    for (int column = static_cast<int>(std::floor(x - kTouch));
         column <= static_cast<int>(std::floor(x + kTouch)); ++column) {
      if (!grid_.contains({column, row})) continue;
      const std::size_t cell = local({column, row});
      for (int side = 0; side < 4; ++side)
        for (int k = 0; k < points_; ++k) {
          const EdgeSpot in = edgeSpot(side, k, points_);
          each({node(cell, side, k), cell, beyond(cell, side)},
               Point{grid_.south_west.x_m + (column + in.x) * grid_.resolution_m,
                     grid_.south_west.y_m + (row + in.y) * grid_.resolution_m});
        }
    }
}

// Price of the first or the last motion; infinite where the cell beyond the edge does not allow its heading.
double Search::priceOfEnd(const Segment& motion, EdgePoint turn) const noexcept {
  const double dx = motion.to.x_m - motion.from.x_m, dy = motion.to.y_m - motion.from.y_m;
  const double length = std::hypot(dx, dy);
  if (length > 0.0 &&
      std::isinf(cost_.map().cost().costPerMetre(codes_[turn.beyond], {dx / length, dy / length})))
    return kFar;
  return cost_(motion);
}

void Search::reach(std::uint32_t node, float label, std::uint32_t from, std::uint32_t cell) {
  if (!(label < label_[node])) return;
  label_[node] = label;
  from_[node] = from;
  in_[node] = cell;
  ring_[bucketOf(label) & (ring_.size() - 1)].push_back(node);
  ++queued_;
}

// Whether the heading of motion i from a point of a side may be had in the cells beyond both ends, too: a
// turn on an edge touches both its cells.
bool Search::turnsAllowed(std::size_t cell, int side, EdgeCrossings::End end, int i, int k) const noexcept {
  const std::size_t before = beyond(cell, side), after = beyond(cell, end.side);
  return (free_[before] || crossings_.allowed(side, k, i, codes_[before])) &&
         (free_[after] || crossings_.allowed(side, k, i, codes_[after]));
}

void Search::cross(std::uint32_t node, std::size_t cell, int side, int k) {
  const CellCode code = codes_[cell];
  if (code.curve() >= cost_.map().cost().curves().size()) return;
  const EdgeCrossings::End* end = crossings_.ends(side, k);
  crossings_.prices(side, k, code, label_[node], paid_.data());
  for (int i = 0; i < crossings_.count(); ++i) {
    const float through = paid_[static_cast<std::size_t>(i)];
    const std::uint32_t to = this->node(cell, end[i].side, end[i].k);
    if (through < below_ && through < label_[to] && turnsAllowed(cell, side, end[i], i, k))
      reach(to, through, node, static_cast<std::uint32_t>(cell));
  }
}

void Search::settle(std::uint32_t node) {
  const auto points = static_cast<std::uint32_t>(points_);
  const std::size_t holder = node / points / 2;
  const int k = static_cast<int>(node % points);
  const bool vertical = node / points % 2 == 0;
  const std::size_t before = holder - (vertical ? 1 : columns_);
  if (in_[node] != holder) cross(node, holder, vertical ? kWestSide : kSouthSide, k);
  if (in_[node] != before) cross(node, before, vertical ? kEastSide : kNorthSide, k);
}

EdgePath Search::run(Point from, Point to, double below_J) {
  const double side_m = grid_.resolution_m;
  float least = kFar, most = 0.0F;
  for (const auto& curve : cost_.map().cost().curves())
    for (const float value : curve.cost_J_per_m)
      if (std::isfinite(value)) least = std::min(least, value), most = std::max(most, value);
  if (!(most > 0.0F)) return {};
  // A bucket no wider than the cheapest motion between two points, but not more than a thousand.
  const float width = std::max(least * 0.7F / static_cast<float>(points_), most * 1.5F / 1000.0F);
  per_bucket_ = 1.0F / width;
  ring_.resize(std::bit_ceil(static_cast<std::size_t>(most * 1.5F * per_bucket_) + 2));
  below_ = static_cast<float>(below_J / side_m);
  std::vector<std::uint32_t> last_cell(label_.size(), kNone);
  forEachEdgePoint(to, [&](EdgePoint at, Point p) {
    const auto rest = static_cast<float>(priceOfEnd({p, to}, at) / side_m);
    if (rest < last_[at.node])
      last_[at.node] = rest, last_cell[at.node] = static_cast<std::uint32_t>(at.cell);
  });
  forEachEdgePoint(from, [&](EdgePoint at, Point p) {
    const auto first = static_cast<float>(priceOfEnd({from, p}, at) / side_m);
    if (first < below_) reach(at.node, first, kNone, static_cast<std::uint32_t>(at.cell));
  });
  std::uint32_t best = kNone;
  for (std::size_t current = 0; queued_ > 0; ++current) {
    auto& bucket = ring_[current & (ring_.size() - 1)];
    for (std::size_t i = 0; i < bucket.size(); ++i) {
      const std::uint32_t node = bucket[i];
      if (bucketOf(label_[node]) != current) continue;
      if (label_[node] + last_[node] < below_) below_ = label_[node] + last_[node], best = node;
      settle(node);
    }
    queued_ -= bucket.size();
    bucket.clear();
  }
  EdgePath path;
  if (best == kNone) return path;
  const auto inCells = [&](Point p) {
    return EdgePath::Turn{(p.x_m - grid_.south_west.x_m) / side_m, (p.y_m - grid_.south_west.y_m) / side_m,
                          false};
  };
  path.turns.push_back(inCells(to));
  path.cells.push_back(cellOf(last_cell[best]));
  for (std::uint32_t at = best; at != kNone; at = from_[at]) {
    const EdgeSpot s = spotOfNode(at);
    path.turns.push_back({s.x, s.y, at / static_cast<std::uint32_t>(points_) % 2 == 0});
    path.cells.push_back(cellOf(in_[at]));
  }
  path.turns.push_back(inCells(from));
  std::reverse(path.turns.begin(), path.turns.end());
  std::reverse(path.cells.begin(), path.cells.end());
  return path;
}

}  // namespace

EdgePath searchCorridor(const MotionCost& cost, const std::vector<Point>& along, double below_J,
                        const CorridorOptions& options) {
  return Search(cost, along, options).run(along.front(), along.back(), below_J);
}

}  // namespace talus::planner
