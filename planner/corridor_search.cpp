#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include <planner/corridor_search.hpp>
#include <planner/heading_cost.hpp>

namespace talus::planner {
namespace {

using costmap::CellCode;
using maps::Cell;
using maps::Point;

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

enum Side : int { kWestSide, kEastSide, kSouthSide, kNorthSide };

// A point of a cell's edge, in cells from the cell's south-west corner.
struct Spot {
  double x, y;
};

Spot spotOf(int side, int k, int points) noexcept {
  const double t = (k + 0.5) / points;
  switch (side) {
    case kWestSide:
      return {0.0, t};
    case kEastSide:
      return {1.0, t};
    case kSouthSide:
      return {t, 0.0};
    default:
      return {t, 1.0};
  }
}

// All motions across a cell from a point of its edge to points of the other three.
struct Motion {
  HeadingCost cost;
  float length;
  int side, k;  // where it ends
};

class Motions {
 public:
  Motions(const costmap::DriveCost& cost, int points) : points_(points) {
    for (int side = 0; side < 4; ++side)
      for (int k = 0; k < points; ++k)
        for (int to = 0; to < 4; ++to)
          for (int l = 0; l < points && to != side; ++l) {
            const Spot a = spotOf(side, k, points), b = spotOf(to, l, points);
            const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
            all_.push_back(
                {HeadingCost(cost, {dx / length, dy / length}), static_cast<float>(length), to, l});
          }
  }
  const Motion* from(int side, int k) const noexcept {
    return all_.data() + static_cast<std::size_t>((side * points_ + k) * each());
  }
  int each() const noexcept { return 3 * points_; }

 private:
  int points_;
  std::vector<Motion> all_;
};

class Search {
 public:
  Search(const MotionCost& cost, const std::vector<Point>& along, const CorridorOptions& options)
      : cost_(cost),
        grid_(cost.map().grid()),
        points_(options.points_per_edge),
        motions_(cost.map().cost(), options.points_per_edge) {
    open(along, options.reach_cells);
  }

  EdgePath run(Point from, Point to, double below_J);

 private:
  struct End {
    Cell cell{};
    float cost = kFar;
  };

  void open(const std::vector<Point>& along, int reach);
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
  Cell cellOf(std::size_t local) const noexcept {
    return {first_.column + static_cast<int>(local % columns_),
            first_.row + static_cast<int>(local / columns_)};
  }
  Spot spotOfNode(std::uint32_t node) const noexcept;
  template <typename Each>
  void forEachEdgePoint(Point place, Each each) const;
  void reach(std::uint32_t node, float label, std::uint32_t from, std::uint32_t cell);
  void settle(std::uint32_t node);
  void cross(std::uint32_t node, std::size_t cell, int side, int k);
  std::size_t bucketOf(float label) const noexcept { return static_cast<std::size_t>(label * per_bucket_); }

  const MotionCost& cost_;
  const maps::Grid& grid_;
  int points_;
  Motions motions_;
  Cell first_{};  // of the box, two cells of margin around: an end on an edge touches the next cell
  std::size_t columns_ = 0;  // of the box
  std::vector<CellCode> codes_;
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
    return Spot{(p.x_m - grid_.south_west.x_m) / grid_.resolution_m,
                (p.y_m - grid_.south_west.y_m) / grid_.resolution_m};
  };
  Spot before = inCells(along.front());
  for (const Point p : along) {
    const Spot here = inCells(p);
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
  std::vector<bool> done(codes_.size());
  for (const Cell c : on) {
    for (int row = std::max(c.row - reach, 0); row <= std::min(c.row + reach, grid_.height - 1); ++row)
      for (int column = std::max(c.column - reach, 0); column <= std::min(c.column + reach, grid_.width - 1);
           ++column) {
        const std::size_t at = local({column, row});
        if (done[at]) continue;
        done[at] = true;
        codes_[at] = cost_.map().at({column, row});
      }
  }
  const std::size_t nodes = codes_.size() * 2 * static_cast<std::size_t>(points_);
  label_.assign(nodes, kFar);
  last_.assign(nodes, kFar);
  from_.assign(nodes, kNone);
  in_.assign(nodes, kNone);
}

Spot Search::spotOfNode(std::uint32_t node) const noexcept {
  const auto points = static_cast<std::uint32_t>(points_);
  const Cell c = cellOf(node / points / 2);
  const Spot in =
      spotOf(node / points % 2 == 0 ? kWestSide : kSouthSide, static_cast<int>(node % points), points_);
  return {c.column + in.x, c.row + in.y};
}

// Calls each(node, point, local cell) for the edge points of every cell that the place touches.
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
          const Spot in = spotOf(side, k, points_);
          each(node(cell, side, k),
               Point{grid_.south_west.x_m + (column + in.x) * grid_.resolution_m,
                     grid_.south_west.y_m + (row + in.y) * grid_.resolution_m},
               cell);
        }
    }
}

void Search::reach(std::uint32_t node, float label, std::uint32_t from, std::uint32_t cell) {
  if (!(label < label_[node])) return;
  label_[node] = label;
  from_[node] = from;
  in_[node] = cell;
  ring_[bucketOf(label) & (ring_.size() - 1)].push_back(node);
  ++queued_;
}

void Search::cross(std::uint32_t node, std::size_t cell, int side, int k) {
  const CellCode code = codes_[cell];
  if (code.curve() >= cost_.map().cost().curves().size()) return;
  const Motion* motion = motions_.from(side, k);
  const float here = label_[node];
  for (int i = 0; i < motions_.each(); ++i, ++motion) {
    const float through = here + motion->cost(code) * motion->length;
    if (through < below_)
      reach(this->node(cell, motion->side, motion->k), through, node, static_cast<std::uint32_t>(cell));
  }
}

void Search::settle(std::uint32_t node) {
  const auto points = static_cast<std::uint32_t>(points_);
  const std::size_t holder = node / points / 2;
  const int k = static_cast<int>(node % points);
  const bool vertical = node / points % 2 == 0;
  cross(node, holder, vertical ? kWestSide : kSouthSide, k);
  cross(node, holder - (vertical ? 1 : columns_), vertical ? kEastSide : kNorthSide, k);
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
  forEachEdgePoint(to, [&](std::uint32_t node, Point p, std::size_t cell) {
    const auto rest = static_cast<float>(cost_({p, to}) / side_m);
    if (rest < last_[node]) last_[node] = rest, last_cell[node] = static_cast<std::uint32_t>(cell);
  });
  forEachEdgePoint(from, [&](std::uint32_t node, Point p, std::size_t cell) {
    const auto first = static_cast<float>(cost_({from, p}) / side_m);
    if (first < below_) reach(node, first, kNone, static_cast<std::uint32_t>(cell));
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
    const Spot s = spotOfNode(at);
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
