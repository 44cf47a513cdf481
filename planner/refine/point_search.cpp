#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include <talus/common/common.hpp>
#include <talus/planner/refine/point_search.hpp>

namespace talus::planner {

using costmap::CellCode;
using costmap::Direction;
using maps::Cell;
using maps::Point;

namespace {

constexpr double kFiner = 0.7;       // factor of the spacing of positions from round to round
constexpr double kClear = 1.0 / 64;  // [cells] smallest distance of turns from corners
constexpr double kTouch = 1e-6;      // [cells] distance up to which a point belongs to a cell

// A turn in cell coordinates, and how it may move.
struct Turn {
  enum class Moves { Not, AlongX, AlongY };
  double x, y;
  Moves moves;
};

// Points to which a turn may move, the first of `places` is the present point; the least cost from each to the
// end of the path, and the next point on that path.
struct Choice {
  std::array<Turn, 3> places;
  std::array<double, 3> best{};
  std::array<std::size_t, 3> next{};
  std::size_t count = 0;

  Choice(const Turn& turn, double step) {
    places[count++] = turn;
    if (turn.moves == Turn::Moves::Not) return;
    double Turn::*const way = turn.moves == Turn::Moves::AlongX ? &Turn::x : &Turn::y;
    const double side = std::floor(turn.*way);
    for (const double moved : {turn.*way + step, turn.*way - step}) {
      if (moved < side + kClear || moved > side + 1.0 - kClear) continue;
      places[count] = turn;
      places[count++].*way = moved;
    }
  }
};

// Straight motion between two turns.
struct Straight {
  double length;
  HeadingCost cost;

  Straight(const costmap::TravelCost& drive, const Turn& from, const Turn& to) noexcept
      : length(std::hypot(to.x - from.x, to.y - from.y)),
        cost(drive,
             length > 0.0 ? Direction{(to.x - from.x) / length, (to.y - from.y) / length} : Direction{}) {}

  bool permitted(CellCode cell) const noexcept { return !(length > 0.0) || std::isfinite(cost(cell)); }
};

// The cell of a motion, and the cells before and after it, which its turns touch. A cell that permits the heading
// of the motion must still permit it when the turns are moved.
struct Passage {
  CellCode cell, before, after;
  bool before_permits, after_permits;
};

void choose(const costmap::TravelCost& drive, const Passage& passage, Choice& from, const Choice& to) {
  for (std::size_t a = 0; a < from.count; ++a) {
    from.best[a] = kInfinity;
    for (std::size_t b = 0; b < to.count; ++b) {
      const Straight motion(drive, from.places[a], to.places[b]);
      const double through =
          (motion.length > 0.0 ? motion.length * static_cast<double>(motion.cost(passage.cell)) : 0.0) +
          to.best[b];
      if (!(through < from.best[a]) || (passage.before_permits && !motion.permitted(passage.before)) ||
          (passage.after_permits && !motion.permitted(passage.after)))
        continue;
      from.best[a] = through;
      from.next[a] = b;
    }
  }
}

void slideOnce(const costmap::TravelCost& drive, const std::vector<Passage>& passages, double step,
               std::vector<Turn>& turns) {
  std::vector<Choice> choices;
  choices.reserve(turns.size());
  for (const Turn& turn : turns) choices.emplace_back(turn, step);
  for (std::size_t i = passages.size(); i-- > 0;) choose(drive, passages[i], choices[i], choices[i + 1]);
  for (std::size_t i = 0, a = 0; i < turns.size(); ++i) {
    turns[i] = choices[i].places[a];
    a = choices[i].next[a];
  }
}

Cell beyond(Cell cell, int side) noexcept {
  constexpr std::array<Cell, 4> kSteps{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  const Cell step = kSteps[static_cast<std::size_t>(side)];
  return {cell.column + step.column, cell.row + step.row};
}

}  // namespace

std::vector<std::size_t> slideTurns(const costmap::CostGrid& map, PointPath& path, double coarsest_cells,
                                    int rounds) {
  const maps::Grid& grid = map.grid();
  const std::size_t last = path.cells.size();
  std::vector<Turn> turns;
  for (const Point p : path.points)
    turns.push_back({(p.x_m - grid.south_west.x_m) / grid.resolution_m,
                     (p.y_m - grid.south_west.y_m) / grid.resolution_m, Turn::Moves::Not});
  std::vector<Passage> passages;
  for (std::size_t i = 0; i < last; ++i) {
    const CellCode before = map.at(path.cells[i > 0 ? i - 1 : 0]),
                   after = map.at(path.cells[std::min(i + 1, last - 1)]);
    const Straight motion(map.cost(), turns[i], turns[i + 1]);
    passages.push_back(
        {map.at(path.cells[i]), before, after, motion.permitted(before), motion.permitted(after)});
  }
  const auto holds = [](Cell cell, const Turn& turn) {
    return std::abs(turn.x - cell.column - 0.5) <= 0.5 + kTouch &&
           std::abs(turn.y - cell.row - 0.5) <= 0.5 + kTouch;
  };
  std::vector<std::size_t> held;
  for (std::size_t i = 1; i < last; ++i) {
    const bool row = path.cells[i - 1].row == path.cells[i].row,
               column = path.cells[i - 1].column == path.cells[i].column;
    const bool beyond_cell =
        (i == 1 && !holds(path.cells[0], turns[0])) || (i + 1 == last && !holds(path.cells[i], turns[last]));
    if (row == column || beyond_cell || !passages[i - 1].after_permits || !passages[i].before_permits) {
      held.push_back(i);
      continue;
    }
    turns[i].moves = row ? Turn::Moves::AlongY : Turn::Moves::AlongX;
  }
  double step = coarsest_cells;
  for (int k = 0; k < rounds; ++k, step *= kFiner) slideOnce(map.cost(), passages, step, turns);
  for (std::size_t i = 1; i < last; ++i)
    path.points[i] = {grid.south_west.x_m + turns[i].x * grid.resolution_m,
                      grid.south_west.y_m + turns[i].y * grid.resolution_m};
  return held;
}

SearchRegion::SearchRegion(const maps::Grid& grid) : first_{0, 0}, last_{grid.width - 1, grid.height - 1} {}

SearchRegion::SearchRegion(const maps::Grid& grid, const Polyline& along,
                           const std::function<int(Cell)>& reach_cells)
    : first_{grid.width - 1, grid.height - 1}, last_{0, 0} {
  std::vector<maps::CellBox> boxes;
  std::optional<Cell> before;
  for (const Point p : subdivided(along, grid.resolution_m)) {
    const Cell cell{
        std::clamp(static_cast<int>((p.x_m - grid.south_west.x_m) / grid.resolution_m), 0, grid.width - 1),
        std::clamp(static_cast<int>((p.y_m - grid.south_west.y_m) / grid.resolution_m), 0, grid.height - 1)};
    if (before == cell) continue;
    before = cell;
    const int reach = reach_cells(cell);
    const maps::CellBox box{
        {std::max(cell.column - reach, 0), std::max(cell.row - reach, 0)},
        {std::min(cell.column + reach, grid.width - 1), std::min(cell.row + reach, grid.height - 1)}};
    first_ = {std::min(first_.column, box.first.column), std::min(first_.row, box.first.row)};
    last_ = {std::max(last_.column, box.last.column), std::max(last_.row, box.last.row)};
    boxes.push_back(box);
  }
  open_.assign(size(), 0);
  for (const maps::CellBox& box : boxes)
    for (int row = box.first.row; row <= box.last.row; ++row)
      std::fill_n(open_.begin() + static_cast<std::ptrdiff_t>(local({box.first.column, row})), box.width(),
                  std::uint8_t{1});
}

PointSearch::PointSearch(const MotionCost& cost, PointCounts counts) : cost_(cost), counts_(counts) {
  for (int side = 0; side < kInside; ++side)
    for (int k = 0; k < counts.side; ++k) {
      const double at = (k + 0.5) / counts.side, end = side == kEast || side == kNorth ? 1.0 : 0.0;
      spots_.push_back(side < kSouth ? Spot{side, end, at} : Spot{side, at, end});
    }
  for (int k = 0; k < counts.inner * counts.inner; ++k)
    spots_.push_back(
        {kInside, (k % counts.inner + 0.5) / counts.inner, (k / counts.inner + 0.5) / counts.inner});
  for (const Spot& from : spots_) {
    auto& legs = legs_.emplace_back();
    std::array<std::uint32_t, kSides> number{};
    for (const Spot& to : spots_) {
      const auto side = static_cast<std::size_t>(to.side);
      const std::uint32_t k = number[side]++;
      const double dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy);
      if (length == 0.0 || (from.side < kInside && from.side == to.side)) continue;
      legs[side].push_back({k, headingOf({dx / length, dy / length}), static_cast<float>(length)});
    }
  }
  for (const costmap::TravelCurve& curve : cost.map().cost().curves())
    free_up_to_.push_back(gentleGradient(cost.map().cost(), curve));
}

std::uint32_t PointSearch::headingOf(Direction direction) {
  constexpr double kSame = 1e-9;
  const auto known = std::ranges::find_if(headings_, [&](const Direction& other) {
    return std::abs(other.x - direction.x) < kSame && std::abs(other.y - direction.y) < kSame;
  });
  if (known != headings_.end()) return static_cast<std::uint32_t>(known - headings_.begin());
  headings_.push_back(direction);
  heading_costs_.emplace_back(cost_.map().cost(), direction);
  return static_cast<std::uint32_t>(headings_.size() - 1);
}

bool PointSearch::free(CellCode cell) const noexcept {
  if (cell.curve() >= free_up_to_.size()) return false;
  const double x = cell.dzDx(), y = cell.dzDy(), reach = free_up_to_[cell.curve()];
  return x * x + y * y < reach * reach;
}

// One search. The nodes of a cell are the points of its west and south side, twice, and those inside. The
// first of the two nodes of a point on a side is reached on a heading that both adjacent cells permit, the
// second, "loose" one on a heading that only the crossed cell permits; a loose node may only be left on a
// heading that both permit.
class PointSearchRun {
 public:
  PointSearchRun(const PointSearch& of, const PointSearch::Task& task, const SearchRegion& region)
      : of_(of),
        map_(of.cost_.map()),
        grid_(map_.grid()),
        task_(task),
        region_(region),
        most_J_(task.below_J),
        n_(static_cast<std::uint32_t>(of.counts_.side)),
        per_cell_(4 * n_ + static_cast<std::uint32_t>(of.counts_.inner * of.counts_.inner)),
        slot_of_(region.size(), kNone) {}

  PointPath run() {
    start();
    std::size_t taken = 0;
    while (!open_.empty()) {
      const auto [least, node] = open_.top();
      open_.pop();
      if (static_cast<double>(least) >= most_J_ || taken > kMostTaken) break;
      const Point here = place(node);
      if (least > labels_[node] + rest(here)) continue;
      if ((++taken & 0xfffU) == 0 && task_.stop()) return {};
      expand(node, here);
    }
    return path();
  }

 private:
  using Side = PointSearch::Side;

  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  static constexpr float kNotReached = std::numeric_limits<float>::infinity(), kUnpriced = -1.0F;
  static constexpr std::size_t kMostTaken = 2'000'000;  // nodes

  float rest(Point at) const { return task_.rest ? static_cast<float>(task_.rest(at)) : 0.0F; }

  std::uint32_t slotOf(Cell cell) {
    std::uint32_t& slot = slot_of_[region_.local(cell)];
    if (slot == kNone) {
      slot = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back(cell);
      labels_.resize(cells_.size() * per_cell_, kNotReached);
      from_.resize(labels_.size(), kNone);
      prices_.resize(cells_.size() * of_.headings_.size(), kUnpriced);
    }
    return slot;
  }
  // First node of a side of a cell, or of the points inside.
  std::uint32_t firstNode(Cell cell, int side) {
    if (side == Side::kEast) ++cell.column;
    if (side == Side::kNorth) ++cell.row;
    return slotOf(cell) * per_cell_ + (side == Side::kInside ? 4 * n_ : side >= Side::kSouth ? n_ : 0);
  }
  std::uint32_t loose() const noexcept { return 2 * n_; }
  // The cell of a node, and its point. A point on a side belongs to two cells; the cell east or north of the
  // side is returned.
  std::pair<Cell, std::size_t> whereIs(std::uint32_t node) const {
    const std::uint32_t k = node % per_cell_, strict = k % (2 * n_);
    const std::size_t spot = k >= 4 * n_ ? k : strict < n_ ? strict : n_ + strict;
    return {cells_[node / per_cell_], spot};
  }
  Point placeOf(Cell cell, std::size_t spot) const {
    return {grid_.south_west.x_m + (cell.column + of_.spots_[spot].x) * grid_.resolution_m,
            grid_.south_west.y_m + (cell.row + of_.spots_[spot].y) * grid_.resolution_m};
  }
  Point place(std::uint32_t node) const {
    const auto [cell, spot] = whereIs(node);
    return placeOf(cell, spot);
  }
  Cell cellBetween(Point a, Point b) const {
    return *grid_.cellAt({0.5 * (a.x_m + b.x_m), 0.5 * (a.y_m + b.y_m)});
  }

  // Returns true if a leg between a spot of the cell and a place leads through the inside of the cell.
  bool through(Cell cell, std::size_t spot, Point end) const {
    const int side = of_.spots_[spot].side;
    const Point at = placeOf(cell, spot);
    return side == Side::kInside ? !(at == end) : side < Side::kSouth ? at.x_m != end.x_m : at.y_m != end.y_m;
  }

  void start() {
    const double around_m = grid_.resolution_m;  // more headings than from the points of one cell
    goals_ = cellsWithin(grid_, task_.places.to, around_m);
    for (const Cell cell : cellsWithin(grid_, task_.places.from, around_m)) {
      if (!region_.contains(cell)) continue;
      std::array<std::uint32_t, Side::kSides> number{};
      for (std::size_t spot = 0; spot < of_.spots_.size(); ++spot) {
        const int side = of_.spots_[spot].side;
        const std::uint32_t k = number[static_cast<std::size_t>(side)]++;
        if (!through(cell, spot, task_.places.from)) continue;
        if (side < Side::kInside && !region_.contains(beyond(cell, side))) continue;
        const Segment leg{task_.places.from, placeOf(cell, spot)};
        const bool strict = side == Side::kInside || of_.cost_.turnAllowed(leg, leg.to);
        reach(firstNode(cell, side) + k + (strict ? 0 : loose()), of_.cost_(leg), kNone, leg.to);
      }
    }
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

  void expand(std::uint32_t node, Point here) {
    const auto [cell, spot] = whereIs(node);
    const Point before = from_[node] == kNone ? task_.places.from : place(from_[node]);
    const Direction heading = directionOf({before, here});
    const Cell crossed = cellBetween(before, here);
    if (distance_m(here, task_.places.to) <= task_.tolerance_m) end(node, labels_[node], here);
    const auto enter = [&](Cell in, std::size_t at) {
      if (!region_.contains(in)) return;
      if (std::ranges::find(goals_, in) != goals_.end() && through(in, at, task_.places.to)) {
        const Segment leg{here, task_.places.to};
        if (of_.cost_.turnAllowed(leg, here))
          end(node,
              static_cast<double>(labels_[node]) + of_.cost_(leg) +
                  of_.cost_.turn(here, heading, directionOf(leg)),
              leg.to);
      }
      cross(node, in, at, heading, in == crossed);
    };
    enter(cell, spot);
    if (of_.spots_[spot].side != Side::kInside) enter(beyond(cell, of_.spots_[spot].side), spot + n_);
  }

  void end(std::uint32_t node, double cost_J, Point goal) {
    if (!(cost_J < most_J_)) return;
    most_J_ = cost_J;
    last_ = node;
    goal_ = goal;
  }

  float price(std::uint32_t slot, CellCode code, std::uint32_t heading) {
    float& price = prices_[slot * of_.headings_.size() + heading];
    if (price == kUnpriced) price = of_.heading_costs_[heading](code);
    return price;
  }

  void cross(std::uint32_t node, Cell cell, std::size_t spot, Direction heading, bool back) {
    const CellCode code = map_.at(cell);
    const bool free = of_.free(code);
    if (code.curve() >= map_.cost().curves().size() || (back && free)) return;
    const int side = of_.spots_[spot].side;
    const bool shared = side == Side::kInside || of_.free(map_.at(beyond(cell, side)));
    const bool must_share = node % per_cell_ >= loose() && side != Side::kInside;
    const std::uint32_t slot = slotOf(cell);
    const double turn_J = map_.cost().cost_J(map_.cost().turn(code));
    const float label = labels_[node];
    for (int to = 0; to < Side::kSides; ++to) {
      const Cell other = to == Side::kInside ? cell : beyond(cell, to);
      if (to == Side::kInside ? free : to == side || !region_.contains(other)) continue;
      const bool both = to == Side::kInside || of_.free(map_.at(other));
      const std::uint32_t first = firstNode(cell, to), other_slot = slotOf(other);
      for (const PointSearch::Leg& leg : of_.legs_[spot][static_cast<std::size_t>(to)]) {
        const float paid = price(slot, code, leg.heading);
        double through =
            static_cast<double>(label) + static_cast<double>(paid * leg.length) * grid_.resolution_m;
        std::uint32_t next = first + leg.number;
        const float most =
            to == Side::kInside ? labels_[next] : std::max(labels_[next], labels_[next + loose()]);
        if (!(static_cast<float>(through) < most)) continue;
        if (must_share && !shared && !permits(beyond(cell, side), leg.heading)) continue;
        if (!both && !(price(other_slot, map_.at(other), leg.heading) < kNotReached)) {
          next += loose();
        }
        if (turn_J > 0.0) {
          const Direction leaves = of_.headings_[leg.heading];
          through += turn_J * std::acos(std::clamp(leaves.x * heading.x + leaves.y * heading.y, -1.0, 1.0));
        }
        reach(next, through, node, placeOf(cell, static_cast<std::size_t>(to) * n_ + leg.number));
      }
    }
  }
  bool permits(Cell cell, std::uint32_t heading) {
    return price(slotOf(cell), map_.at(cell), heading) < kNotReached;
  }

  PointPath path() const {
    PointPath path;
    if (last_ == kNone) return path;
    if (!(place(last_) == goal_)) path.points.push_back(goal_);
    for (std::uint32_t at = last_; at != kNone; at = from_[at]) path.points.push_back(place(at));
    path.points.push_back(task_.places.from);
    std::ranges::reverse(path.points);
    for (std::size_t i = 1; i < path.points.size(); ++i)
      path.cells.push_back(cellBetween(path.points[i - 1], path.points[i]));
    return path;
  }

  const PointSearch& of_;
  const costmap::CostGrid& map_;
  const maps::Grid& grid_;
  const PointSearch::Task& task_;
  const SearchRegion& region_;
  double most_J_;
  std::uint32_t n_, per_cell_;          // points on a side; nodes
  std::vector<std::uint32_t> slot_of_;  // by cell of the region
  std::vector<Cell> cells_, goals_;     // by slot; cells from which a leg may end at the goal
  std::vector<float> labels_, prices_;  // by node; by slot and heading
  std::vector<std::uint32_t> from_;
  std::priority_queue<std::pair<float, std::uint32_t>, std::vector<std::pair<float, std::uint32_t>>,
                      std::greater<>>
      open_;
  std::uint32_t last_ = kNone;
  Point goal_{};
};

PointPath PointSearch::operator()(const Task& task, const SearchRegion& region) const {
  return PointSearchRun(*this, task, region).run();
}

}  // namespace talus::planner
