#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include <talus/planner/refine/corridor.hpp>
#include <talus/planner/refine/corridor_search.hpp>

namespace talus::planner {
namespace {

using costmap::CellCode;
using maps::Cell;
using maps::Point;

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kNone = Corridor::kNone;

// Bucket queue of node indices ordered by labels; within a bucket in order of insertion.
class LabelQueue {
 public:
  // `reach` is the largest difference of labels queued at the same time.
  LabelQueue(float width, float reach)
      : per_bucket_(1.0F / width), ring_(std::bit_ceil(static_cast<std::size_t>(reach * per_bucket_) + 2)) {}

  std::size_t bucketOf(float label) const noexcept { return static_cast<std::size_t>(label * per_bucket_); }

  void push(float label, std::uint32_t number) {
    Bucket& bucket = ring_[bucketOf(label) & (ring_.size() - 1)];
    const auto entry = static_cast<std::uint32_t>(entries_.size());
    (bucket.last == kNone ? bucket.first : entries_[bucket.last].next) = entry;
    bucket.last = entry;
    entries_.push_back({number, kNone});
  }

  // Returns true if both labels belong to the same bucket and that bucket was not taken yet.
  bool together(float label, float other) const noexcept {
    return bucketOf(label) == bucketOf(other) && bucketOf(label) > current_;
  }

  // Calls take(node) for every queued node index, including those queued by take(). Entries whose current
  // label(node) belongs to another bucket are skipped.
  template <typename Label, typename Take>
  void run(Label label, Take take) {
    for (std::size_t taken = 0; taken < entries_.size(); ++current_) {
      Bucket& bucket = ring_[current_ & (ring_.size() - 1)];
      for (std::uint32_t e = bucket.first; e != kNone; e = entries_[e].next, ++taken)
        if (bucketOf(label(entries_[e].number)) == current_) take(entries_[e].number);
      bucket = {};
    }
  }

 private:
  struct Bucket {
    std::uint32_t first = kNone, last = kNone;
  };
  struct Entry {
    std::uint32_t number, next;
  };

  float per_bucket_;
  std::size_t current_ = 0;
  std::vector<Bucket> ring_;
  std::vector<Entry> entries_;
};

// Bucket width: at most the cheapest motion between two points, but at least a thousandth of the reach.
LabelQueue queueFor(const CostRange& range, int points) {
  const auto highest = static_cast<float>(range.most_J_per_m * 1.5);  // across a cell
  const auto cheapest = static_cast<float>(range.least_J_per_m * 0.7 / points);
  return {std::max(cheapest, highest / 1000.0F), highest};
}

class EdgePointSearch {
 public:
  EdgePointSearch(const MotionCost& cost, const EdgeCrossings& crossings, Corridor& corridor,
                  LabelQueue queue)
      : cost_(cost),
        grid_(cost.map().grid()),
        points_(crossings.points()),
        shift_(static_cast<int>(std::bit_width(static_cast<unsigned>(2 * points_ - 1)))),
        crossings_(crossings),
        corridor_(corridor),
        paid_(static_cast<std::size_t>(crossings_.count() + EdgeCrossings::kVector)),
        queue_(std::move(queue)) {}

  EdgePath run(const Segment& ends, double below_J);

 private:
  // A point on the edge of a cell of the corridor: index of its node, cells on both sides, map coordinates,
  // and cost [J per metre of cell size] of the first or last motion of the route, which ends at the point.
  struct EdgePoint {
    std::uint32_t node;
    std::size_t cell, beyond;
    Point place;
    float price = kFar;
  };

  // First node of a cell's side; the nodes of a side are consecutive.
  std::uint32_t firstNode(std::size_t cell, int side) const noexcept {
    const std::size_t holder = side == kEastSide || side == kNorthSide ? corridor_.beyond(cell, side) : cell;
    return (corridor_.holder(holder) << shift_) +
           (side >= kSouthSide ? static_cast<std::uint32_t>(points_) : 0U);
  }
  std::vector<EdgePoint> around(Point place);
  EdgePath::Turn turnAt(Point p) const noexcept;
  EdgePath::Turn turnAt(std::uint32_t node) const noexcept;
  float priceOfEnd(const Segment& motion, const EdgePoint& turn) const noexcept;
  void reach(std::uint32_t node, float label, std::uint32_t from, std::size_t cell);
  void settle(std::uint32_t node);
  void cross(std::uint32_t node, std::size_t cell, int side, int k);
  EdgePath pathTo(std::uint32_t node, std::size_t last_cell, const Segment& ends) const;

  const MotionCost& cost_;
  const maps::Grid& grid_;
  int points_;
  int shift_;  // nodes are numbered by holder: 2^shift_ per holder, of which 2 * points_ are used
  const EdgeCrossings& crossings_;
  Corridor& corridor_;
  std::vector<float> paid_;
  LabelQueue queue_;
  std::vector<float> label_, last_;       // by node: cost from the start; cost to the end
  std::vector<std::uint32_t> from_, in_;  // previous node (kNone: the start); local cell crossed
  float below_ = kFar;
};

// The edge points of every cell that the place touches.
std::vector<EdgePointSearch::EdgePoint> EdgePointSearch::around(Point place) {
  std::vector<EdgePoint> found;
  const double x = (place.x_m - grid_.south_west.x_m) / grid_.resolution_m,
               y = (place.y_m - grid_.south_west.y_m) / grid_.resolution_m;
  constexpr double kTouch = 1e-6;
  const auto cellBelow = [](double at) { return static_cast<int>(std::floor(at - kTouch)); };
  const auto cellAbove = [](double at) { return static_cast<int>(std::floor(at + kTouch)); };
  for (int row = cellBelow(y); row <= cellAbove(y); ++row)
    for (int column = cellBelow(x); column <= cellAbove(x); ++column) {
      if (!grid_.contains({column, row})) continue;
      const std::size_t cell = corridor_.local({column, row});
      corridor_.hold(cell);
      for (int side = 0; side < 4; ++side)
        for (int k = 0; k < points_; ++k) {
          const EdgeSpot in = edgeSpot(side, k, points_);
          found.push_back({firstNode(cell, side) + static_cast<std::uint32_t>(k),
                           cell,
                           corridor_.beyond(cell, side),
                           {grid_.south_west.x_m + (column + in.x) * grid_.resolution_m,
                            grid_.south_west.y_m + (row + in.y) * grid_.resolution_m}});
        }
    }
  return found;
}

EdgePath::Turn EdgePointSearch::turnAt(Point p) const noexcept {
  return {(p.x_m - grid_.south_west.x_m) / grid_.resolution_m,
          (p.y_m - grid_.south_west.y_m) / grid_.resolution_m, false};
}

EdgePath::Turn EdgePointSearch::turnAt(std::uint32_t node) const noexcept {
  const Cell c = corridor_.cell(corridor_.held(node >> shift_));
  const int k = static_cast<int>(node & ((1U << shift_) - 1));
  const bool vertical = k < points_;
  const EdgeSpot in = edgeSpot(vertical ? kWestSide : kSouthSide, k % points_, points_);
  return {c.column + in.x, c.row + in.y, vertical};
}

// Returns the cost [J] of the first or last motion divided by the cell size [m]; infinite if the cell beyond
// the edge does not allow the heading.
float EdgePointSearch::priceOfEnd(const Segment& motion, const EdgePoint& turn) const noexcept {
  const double dx = motion.to.x_m - motion.from.x_m, dy = motion.to.y_m - motion.from.y_m;
  const double length = std::hypot(dx, dy);
  if (length > 0.0 &&
      std::isinf(cost_.map().cost().costPerMetre(corridor_.code(turn.beyond), {dx / length, dy / length})))
    return kFar;
  return static_cast<float>(cost_(motion) / grid_.resolution_m);
}

void EdgePointSearch::reach(std::uint32_t node, float label, std::uint32_t from, std::size_t cell) {
  const float before = label_[node];
  if (!(label < before)) return;
  label_[node] = label;
  from_[node] = from;
  in_[node] = static_cast<std::uint32_t>(cell);
  if (before == kFar || !queue_.together(label, before)) queue_.push(label, node);
}

void EdgePointSearch::cross(std::uint32_t node, std::size_t cell, int side, int k) {
  const CellCode code = corridor_.code(cell);
  if (code.curve() >= cost_.map().cost().curves().size()) return;
  crossings_.prices(side, k, code, label_[node], paid_.data());
  // A turn on an edge touches both adjacent cells, so the cells beyond both ends must allow the heading, too.
  const std::size_t before = corridor_.beyond(cell, side);
  const bool before_free = corridor_.free(before);
  for (int to = 0, i = 0; to < 4; ++to) {
    if (to == side) continue;
    const std::size_t after = corridor_.beyond(cell, to);
    const bool both_free = before_free && corridor_.free(after);
    const std::uint32_t first = firstNode(cell, to);
    for (std::uint32_t l = 0; l < static_cast<std::uint32_t>(points_); ++l, ++i) {
      const float through = paid_[static_cast<std::size_t>(i)];
      if (!(through < below_ && through < label_[first + l])) continue;
      if (both_free || (crossings_.allowed(side, k, i, corridor_.code(before)) &&
                        crossings_.allowed(side, k, i, corridor_.code(after))))
        reach(first + l, through, node, cell);
    }
  }
}

void EdgePointSearch::settle(std::uint32_t node) {
  const std::size_t holder = corridor_.held(node >> shift_);
  const int k = static_cast<int>(node & ((1U << shift_) - 1));
  const bool vertical = k < points_;
  const std::size_t before = corridor_.beyond(holder, vertical ? kWestSide : kSouthSide);
  if (in_[node] != holder) cross(node, holder, vertical ? kWestSide : kSouthSide, k % points_);
  if (in_[node] != before) cross(node, before, vertical ? kEastSide : kNorthSide, k % points_);
}

EdgePath EdgePointSearch::pathTo(std::uint32_t node, std::size_t last_cell, const Segment& ends) const {
  EdgePath path;
  path.turns.push_back(turnAt(ends.to));
  path.cells.push_back(corridor_.cell(last_cell));
  for (std::uint32_t at = node; at != kNone; at = from_[at]) {
    path.turns.push_back(turnAt(at));
    path.cells.push_back(corridor_.cell(in_[at]));
  }
  path.turns.push_back(turnAt(ends.from));
  std::reverse(path.turns.begin(), path.turns.end());
  std::reverse(path.cells.begin(), path.cells.end());
  return path;
}

EdgePath EdgePointSearch::run(const Segment& ends, double below_J) {
  const auto firsts = around(ends.from);
  auto lasts = around(ends.to);
  const std::size_t nodes = corridor_.holders() << shift_;
  label_.assign(nodes, kFar);
  last_.assign(nodes, kFar);
  from_.resize(nodes);
  in_.resize(nodes);
  below_ = static_cast<float>(below_J / grid_.resolution_m);
  for (EdgePoint& at : lasts) {
    at.price = priceOfEnd({at.place, ends.to}, at);
    last_[at.node] = std::min(last_[at.node], at.price);
  }
  for (const EdgePoint& at : firsts) {
    const float first = priceOfEnd({ends.from, at.place}, at);
    if (first < below_) reach(at.node, first, kNone, at.cell);
  }
  std::uint32_t best = kNone;
  queue_.run([&](std::uint32_t node) { return label_[node]; },
             [&](std::uint32_t node) {
               if (label_[node] + last_[node] < below_) below_ = label_[node] + last_[node], best = node;
               settle(node);
             });
  if (best == kNone) return {};
  const auto ending = std::ranges::find_if(
      lasts, [&](const EdgePoint& at) { return at.node == best && at.price == last_[best]; });
  return pathTo(best, ending->cell, ends);
}

}  // namespace

CorridorSearch::CorridorSearch(const MotionCost& cost, const CorridorOptions& options)
    : cost_(cost),
      options_(options),
      crossings_(cost.map().cost(), options.points_per_edge, options.kernels),
      range_(costRange(cost.map().cost())) {}

EdgePath CorridorSearch::operator()(const std::vector<Point>& along, double below_J) const {
  if (!(range_.most_J_per_m > 0.0)) return {};
  Corridor corridor(cost_.map(), crossings_, along, options_.reach_cells);
  return EdgePointSearch(cost_, crossings_, corridor, queueFor(range_, options_.points_per_edge))
      .run({along.front(), along.back()}, below_J);
}

EdgePath searchCorridor(const MotionCost& cost, const std::vector<Point>& along, double below_J,
                        const CorridorOptions& options) {
  return CorridorSearch(cost, options)(along, below_J);
}

}  // namespace talus::planner
