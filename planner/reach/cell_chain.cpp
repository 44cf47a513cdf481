#include <limits>
#include <queue>
#include <unordered_map>
#include <unordered_set>

#include <talus/planner/reach/cell_chain.hpp>

namespace talus::planner {

namespace {

constexpr double kInside = 3e-6;  // sides: MotionCost treats places within 1e-6 of a side as on the side
constexpr int kMostLegs = 4096;   // legs of a zigzag within one cell
constexpr double kLeast = 1e-9;   // sides: shorter distances are rounding

InCell unit(double heading_rad) noexcept {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}

bool inside(InCell p) noexcept {
  return p.x >= kInside && p.x <= 1.0 - kInside && p.y >= kInside && p.y <= 1.0 - kInside;
}

// Returns the share of a unit step that stays inside a cell with a margin.
double stepInside(InCell from, InCell step) noexcept {
  const auto room = [](double at, double by) {
    return by > 0.0 ? (1.0 - at) / by : by < 0.0 ? -at / by : 1.0;
  };
  return 0.4 * std::min(room(from.x, step.x), room(from.y, step.y));
}

// Permitted headings nearest to a heading on both sides, at least `within` [rad] inside their arcs or at a
// quarter of narrow arcs, as turns to the left; right < 0.
struct Sides {
  double right, left;
};
Sides around(const HeadingSet& set, double heading, double within) noexcept {
  Sides sides{-HeadingSet::kTurn, HeadingSet::kTurn};
  for (const HeadingArc& arc : set.arcs()) {
    const double in = std::min(within, 0.25 * arc.width_rad);
    for (const double at : {arc.from_rad + in, arc.from_rad + arc.width_rad - in}) {
      double off = std::fmod(at - heading, HeadingSet::kTurn);
      if (off < 0.0) off += HeadingSet::kTurn;
      sides.left = std::min(sides.left, off);
      sides.right = std::max(sides.right, off - HeadingSet::kTurn);
    }
  }
  return sides;
}

// Appends a zigzag from p to q, both inside the cell, and q. Returns false if no zigzag of at most kMostLegs
// pairs of legs stays inside the cell.
bool inTurns(const Sides& sides, InCell p, InCell q, std::vector<InCell>& way) {
  const InCell d = q - p;
  const double heading = std::atan2(d.y, d.x), length = std::hypot(d.x, d.y);
  const double between = std::sin(sides.left - sides.right);
  if (!(sides.left - sides.right < 0.5 * HeadingSet::kTurn) || !(between > 0.0)) return false;
  // u + v = d with non-negative multiples of the two headings.
  const InCell u = length * std::sin(sides.left) / between * unit(heading + sides.right);
  const InCell v = length * std::sin(-sides.right) / between * unit(heading + sides.left);
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

bool connected(const HeadingSet& set, InCell p, InCell q, std::vector<InCell>& way) {
  const InCell d = q - p;
  const double heading = std::atan2(d.y, d.x), length = std::hypot(d.x, d.y);
  if (length < kLeast) return true;
  double least = 1e-6;
  for (const HeadingArc& arc : set.arcs()) least = std::min(least, 0.25 * arc.width_rad);
  const double off = std::remainder(set.nearest(heading, least) - heading, HeadingSet::kTurn);
  if (std::abs(off) * length < kLeast) {
    way.push_back(q);
    return true;
  }
  return inTurns(around(set, heading, 1e-3), p, q, way) || inTurns(around(set, heading, 1e-5), p, q, way);
}

using maps::Cell;
using maps::Point;

// Shares by which a cone is narrowed at both ends; tried in order until a route is found.
constexpr std::array kCuts{0.3, 0.1, 0.03, 0.01, 1e-3, 0.0};
constexpr double kTouch = 1e-6;  // sides: distance within which MotionCost treats two places as equal

using Ends = std::pair<InCell, InCell>;

InCell nearestOnSegment(InCell a, InCell b, InCell to) noexcept {
  const InCell d = b - a, e = to - a;
  const double square = d.x * d.x + d.y * d.y;
  return a + (square > 0.0 ? std::clamp((d.x * e.x + d.y * e.y) / square, 0.0, 1.0) : 0.0) * d;
}

class Layer {
 public:
  Layer(const MotionCost& cost, const std::vector<ChainLink>& chain, const Segment& places,
        double tolerance_m, const ChainMargins& margins)
      : cost_(cost),
        grid_(cost.map().grid()),
        chain_(chain),
        places_(places),
        tolerance_m_(tolerance_m),
        margins_(margins) {}

  LaidChain laid() {
    std::size_t failed = 0;
    for (const double cut : kCuts) {
      cut_ = cut;
      Polyline way;
      if (funnel() && gates()) way = driven();
      if (!way.empty()) return {std::move(way), 0};
      failed = std::max(failed, failed_);
    }
    return {{}, failed};
  }

 private:
  HeadingCone cone(std::size_t k) const {
    return HeadingCone(chain_[k].headings, chain_[k].everywhere ? 0.0 : cut_);
  }
  int exit(std::size_t k) const noexcept { return otherSide(chain_[k + 1].side); }

  Ends entry(std::size_t k) const {
    if (k == 0)
      return {inCell(grid_, chain_[0].cell, places_.from), inCell(grid_, chain_[0].cell, places_.from)};
    return {onSide(chain_[k].side, ranges_[k].from), onSide(chain_[k].side, ranges_[k].to)};
  }

  // Computes the reachable range of each side from the start forwards, and the end point in the last cell.
  bool funnel() {
    const std::size_t last = chain_.size() - 1;
    ranges_.assign(chain_.size(), {});
    for (std::size_t k = 0; k < last; ++k) {
      const auto [a, b] = entry(k);
      SideRange range{0.0, 1.0};
      if (!chain_[k].everywhere) range = cone(k).reached(a, b, exit(k), margins_.slack);
      ranges_[k + 1] = {std::max(range.from, margins_.apart), std::min(range.to, 1.0 - margins_.apart)};
      if (ranges_[k + 1].empty()) return failedAt(k);
    }
    const auto end = nearestReached(grid_, chain_[last].cell, cone(last), entry(last), places_, tolerance_m_,
                                    margins_.slack);
    if (!end) return failedAt(last);
    end_ = *end;
    return true;
  }

  // Chooses the crossing point on each side from the end backwards: the middle of the range from which the
  // next point is reachable. In cells in which every direction is drivable: the point straight across from
  // the next point, limited to the middle half of the range.
  bool gates() {
    at_.assign(chain_.size(), 0.0);
    InCell target = end_;
    for (std::size_t k = chain_.size() - 1; k > 0; --k) {
      const ChainLink& link = chain_[k];
      SideRange range = ranges_[k];
      if (!link.everywhere) {
        const SideRange to = cone(k).reaching(target, link.side, 1e-9);
        range = {std::max(range.from, to.from), std::min(range.to, to.to)};
        if (range.empty()) return failedAt(k);
      }
      const double wanted = link.side == Side::West || link.side == Side::East ? target.y : target.x;
      const double inner = 0.25 * (range.to - range.from);
      at_[k] = link.everywhere ? std::clamp(wanted, range.from + inner, range.to - inner)
                               : 0.5 * (range.from + range.to);
      target = onSide(otherSide(link.side), at_[k]);
    }
    return true;
  }

  // Candidate headings for crossing the side before a link: near the straight headings before and after the
  // side, near the normal of the side, and the middle of each arc.
  std::vector<double> crossings(std::size_t k) const {
    const HeadingSet both = chain_[k - 1].headings.shared(chain_[k].headings);
    std::vector<double> headings;
    if (both.empty()) return headings;
    const double across = outwards_rad(exit(k - 1));
    const auto add = [&](double heading) {
      if (std::cos(heading - across) > 1e-3 && std::ranges::find(headings, heading) == headings.end())
        headings.push_back(heading);
    };
    const InCell before = placeIn(k - 1), here = placeOut(k - 1), from = placeIn(k),
                 to = k + 1 < chain_.size() ? placeOut(k) : end_;
    add(both.nearest(std::atan2(here.y - before.y, here.x - before.x), 1e-3));
    add(both.nearest(std::atan2(to.y - from.y, to.x - from.x), 1e-3));
    add(both.nearest(across, 1e-3));
    for (const HeadingArc& arc : both.arcs()) add(arc.from_rad + 0.5 * arc.width_rad);
    return headings;
  }

  InCell placeIn(std::size_t k) const {
    return k == 0 ? inCell(grid_, chain_[0].cell, places_.from) : onSide(chain_[k].side, at_[k]);
  }
  InCell placeOut(std::size_t k) const { return onSide(exit(k), at_[k + 1]); }

  // State of the drive at a crossing: heading, index of the previous crossing, and intermediate places.
  struct Passed {
    std::optional<double> heading_rad{};
    std::size_t before = 0;
    std::vector<InCell> way{};
  };

  Polyline driven() {
    std::vector<std::vector<Passed>> passed{{Passed{}}};
    for (std::size_t k = 0; k < chain_.size(); ++k) {
      const bool last = k + 1 == chain_.size();
      std::vector<std::optional<double>> wanted{std::nullopt};
      if (!last) {
        const std::vector<double> headings = crossings(k + 1);
        wanted.assign(headings.begin(), headings.end());
      }
      std::vector<Passed> here;
      for (const std::optional<double>& heading : wanted) {
        const CellGate out{last ? end_ : placeOut(k), heading};
        for (std::size_t i = 0; i < passed.back().size(); ++i) {
          auto way = drivenThrough(chain_[k].headings, {placeIn(k), passed.back()[i].heading_rad}, out);
          if (way.empty()) continue;
          here.push_back({heading, i, std::move(way)});
          break;
        }
      }
      if (here.empty()) return failedAt(k), Polyline{};
      passed.push_back(std::move(here));
    }
    return checked(passed);
  }

  Polyline checked(const std::vector<std::vector<Passed>>& passed) {
    std::vector<std::size_t> links;
    Polyline way;
    for (std::size_t k = chain_.size(), i = 0; k > 0; --k) {
      const Passed& gate = passed[k][i];
      for (auto p = gate.way.rbegin(); p != gate.way.rend(); ++p) {
        way.push_back(onMap(grid_, chain_[k - 1].cell, *p));
        links.push_back(k - 1);
      }
      i = gate.before;
    }
    std::ranges::reverse(way);
    std::ranges::reverse(links);
    way.front() = places_.from;
    if (tolerance_m_ == 0.0) way.back() = places_.to;
    if (std::isfinite(cost_.along(way))) return way;
    for (std::size_t k = 1; k < way.size(); ++k)
      if (!std::isfinite(cost_({way[k - 1], way[k]}))) return failedAt(links[k - 1]), Polyline{};
    return failedAt(0), Polyline{};
  }

  bool failedAt(std::size_t k) {
    failed_ = k;
    return false;
  }

  const MotionCost& cost_;
  const maps::Grid& grid_;
  const std::vector<ChainLink>& chain_;
  Segment places_;
  double tolerance_m_;
  ChainMargins margins_;
  double cut_ = 0.0;
  std::size_t failed_ = 0;
  std::vector<SideRange> ranges_;  // ranges on the entry sides of the links
  std::vector<double> at_;         // positions on these sides
  InCell end_;
};

}  // namespace

std::vector<InCell> drivenThrough(const HeadingSet& headings, const CellGate& in, const CellGate& out) {
  // Lengths of the straight legs at both gates; shorter legs use less of a narrow cone.
  constexpr std::array kSteps{0.2, 0.05, 0.01, 1e-3, 1e-4, 1e-5};
  constexpr int kMany = static_cast<int>(kSteps.size());
  const auto away = [](const CellGate& gate, double step, double sign) {
    if (!gate.heading_rad) return gate.place;
    const InCell h = sign * unit(*gate.heading_rad);
    return gate.place + std::min(step, stepInside(gate.place, h)) * h;
  };
  for (int both = 0; both < 2 * kMany - 1; ++both)
    for (int first = std::max(0, both - kMany + 1); first <= std::min(both, kMany - 1); ++first) {
      if (!in.heading_rad && first > 0) break;
      if (!out.heading_rad && both > first) continue;
      const InCell from = away(in, kSteps[static_cast<std::size_t>(first)], 1.0);
      const InCell to = away(out, kSteps[static_cast<std::size_t>(both - first)], -1.0);
      std::vector<InCell> way{from};
      if (connected(headings, from, to, way)) return way;
    }
  return {};
}

std::optional<InCell> nearestReached(const maps::Grid& grid, Cell cell, const HeadingCone& cone,
                                     const Ends& from, const Segment& places, double tolerance_m,
                                     double slack) {
  const InCell goal = inCell(grid, cell, places.to);
  if (!(tolerance_m > 0.0)) {
    const bool within = std::max(std::abs(goal.x - 0.5), std::abs(goal.y - 0.5)) <= 0.5 + kTouch;
    return within && cone.joins(from.first, from.second, goal, slack) ? std::optional(goal) : std::nullopt;
  }
  const double inside = slack < 0.0 ? 1e-3 : 0.0,
               reach = tolerance_m / grid.resolution_m + (slack < 0.0 ? 0.0 : kTouch);
  const std::vector<InCell> part = cone.reachedPart(from.first, from.second, slack, inside);
  std::optional<InCell> nearest;
  double least = std::numeric_limits<double>::infinity();
  bool left = true, right = true;  // over all sides: true if the goal lies inside
  const auto look = [&](InCell p) {
    const double off = std::hypot(p.x - goal.x, p.y - goal.y);
    if (off >= least || off > reach) return;
    least = off;
    nearest = p;
  };
  for (std::size_t k = 0; k < part.size(); ++k) {
    const InCell a = part[k], b = part[(k + 1) % part.size()];
    look(nearestOnSegment(a, b, goal));
    const double turn = (b.x - a.x) * (goal.y - a.y) - (b.y - a.y) * (goal.x - a.x);
    left = left && turn >= 0.0;
    right = right && turn <= 0.0;
  }
  return !part.empty() && left != right ? std::optional(goal) : nearest;
}

LaidChain laidChain(const MotionCost& cost, const std::vector<ChainLink>& chain, const Segment& places,
                    double tolerance_m, const ChainMargins& margins) {
  return Layer(cost, chain, places, tolerance_m, margins).laid();
}

namespace {

constexpr double kLeastSpare_rad = 4e-3;  // cells with less spare angle need too many turns to reach every
                                          // place
constexpr int kRepeats = 64;              // maximum number of searches, each with one more restricted cell

// Thresholds of a search, in sides of a cell. A route stays inside the exact limits; a proof exceeds them.
struct Extent {
  ChainMargins margins{};
  double least = 1e-7;       // shorter ranges are not followed
  double ends = -1e-6;       // margin of cones at start and goal
  double outwards = 1e-3;    // least cosine between the heading of a crossing and the normal
  double within_rad = 1e-3;  // distance of a crossing's heading from the ends of its arc
};
constexpr Extent kOfRoutes{};
// MotionCost treats places within 1e-6 of a side as on the side; proofs therefore widen the ends. Shorter
// ranges are rounding.
constexpr Extent kOfProofs{.margins = {.slack = 0.0, .apart = 0.0},
                           .least = 1e-9,
                           .ends = 1e-5,
                           .outwards = 1e-6,
                           .within_rad = 0.0};

// Permitted headings in a cell: all, one arc of them, or none.
enum class Use { Whole, OneArc, Never };

// A range of a side through which a path enters a cell; the first nodes represent the start.
struct Node {
  Cell cell;
  int side = -1;
  SideRange range{};
  int parent = -1;
  int arc = -1;  // index of the arc of headings used in the parent's cell; -1: all
};

class Search {
 public:
  Search(const MotionCost& cost, HeadingSets& headings, const Segment& places, double tolerance_m,
         const CellRouteLimits& limits, const StopCheck& stop)
      : cost_(cost),
        map_(cost.map()),
        headings_(headings),
        places_(places),
        tolerance_m_(tolerance_m),
        limits_(limits),
        stop_(stop) {}

  CellRoute route() {
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
      const End end = follow(kOfRoutes);
      if (end != End::Blocked) {
        if (end == End::Exhausted) prove();
        return std::move(found_);
      }
    }
    return std::move(found_);
  }

 private:
  enum class End { Reached, Blocked, Exhausted, Limit };

  void prove() {
    const End end = follow(kOfProofs);
    found_.all_ways = end != End::Limit;
    found_.out_of_reach = end == End::Exhausted;
    found_.cells = passed_cells_;
    double least = std::numeric_limits<double>::infinity();
    const maps::Grid& grid = map_.grid();
    for (std::size_t index = 0; index < passed_.size(); ++index) {
      if (!passed_[index]) continue;
      const auto width = static_cast<std::size_t>(grid.width);
      const maps::Point at = grid.centre({static_cast<int>(index % width), static_cast<int>(index / width)});
      const double off_m = std::hypot(at.x_m - places_.to.x_m, at.y_m - places_.to.y_m);
      if (off_m >= least) continue;
      least = off_m;
      found_.last = at;
    }
  }

  // Searches for the goal. Without a proof, drives must be constructible: returns Blocked if a drive failed,
  // after a cell was restricted for the next search.
  End follow(const Extent& extent) {
    extent_ = extent;
    proof_ = &extent == &kOfProofs;
    nodes_.clear();
    queue_ = {};
    cover_.clear();
    corners_.clear();
    passed_.assign(map_.grid().size(), false);
    passed_cells_ = 0;
    found_.all_ways = false;
    for (const Cell cell : cellsWithin(map_.grid(), places_.from, 0.0)) open({.cell = cell}, 0.0);
    while (!queue_.empty()) {
      const auto [spent, popped] = queue_.top();
      queue_.pop();
      for (const int k : fresh(popped)) {
        if (found_.ways == limits_.ways || ((found_.ways & 0xfffU) == 0 && stop_())) return End::Limit;
        ++found_.ways;
        if (endsIn(k)) {
          if (proof_) return End::Reached;
          const End end = lay(k);
          if (end != End::Exhausted) return end;
        }
        expand(k, -spent);
      }
    }
    found_.all_ways = true;
    return End::Exhausted;
  }

  void open(const Node& node, double spent) {
    nodes_.push_back(node);
    queue_.emplace(-spent, static_cast<int>(nodes_.size()) - 1);
  }

  Use useOf(Cell cell) const {
    const auto known = use_.find(map_.grid().index(cell));
    return proof_ || known == use_.end() ? Use::Whole : known->second;
  }
  bool everywhere(Cell cell, const HeadingCone& cone) const {
    if (proof_) return cone.everywhere();
    return cone.everywhere() && cone.spare_rad() > kLeastSpare_rad && useOf(cell) == Use::Whole;
  }
  bool byArcs(Cell cell, const HeadingCone& cone) const {
    return cone.everywhere() && !everywhere(cell, cone);
  }

  // Ranges of a node that no earlier path reached, as nodes. Cells in which every direction is drivable are
  // expanded once.
  std::vector<int> fresh(int popped) {
    const Node node = nodes_[static_cast<std::size_t>(popped)];
    const std::size_t cell = map_.grid().index(node.cell);
    const HeadingSet& own = headings_.of(map_.at(node.cell));
    if (own.empty() || useOf(node.cell) == Use::Never) return {};
    if (everywhere(node.cell, HeadingCone(own))) {
      if (passed_[cell]) return {};
      pass(cell);
      return {popped};
    }
    pass(cell);
    if (node.side < 0 || onlyCorner(node.range)) return {popped};
    std::vector<int> parts;
    SideCover& cover = cover_[4 * cell + static_cast<std::size_t>(node.side)];
    for (const SideRange& part : cover.added(node.range, extent_.least)) {
      Node piece = node;
      piece.range = part;
      parts.push_back(static_cast<int>(nodes_.size()));
      nodes_.push_back(piece);
    }
    return parts;
  }

  void pass(std::size_t cell) {
    if (!passed_[cell]) ++passed_cells_;
    passed_[cell] = true;
  }

  std::pair<InCell, InCell> ends(const Node& node) const noexcept {
    const InCell start = inCell(map_.grid(), node.cell, places_.from);
    if (node.side < 0) return {start, start};
    return {onSide(node.side, node.range.from), onSide(node.side, node.range.to)};
  }

  // Returns true if a path that entered through this node can end in its cell.
  bool endsIn(int k) const {
    const Node& node = nodes_[static_cast<std::size_t>(k)];
    const InCell goal = inCell(map_.grid(), node.cell, places_.to);
    const double reach = 0.5 + tolerance_m_ / map_.grid().resolution_m + 1e-5;
    if (std::max(std::abs(goal.x - 0.5), std::abs(goal.y - 0.5)) > reach) return false;
    const HeadingSet& own = headings_.of(map_.at(node.cell));
    const HeadingCone cone(own);
    const auto reached = [&](const HeadingCone& by) {
      return nearestReached(map_.grid(), node.cell, by, ends(node), places_, tolerance_m_, extent_.ends)
          .has_value();
    };
    if (!byArcs(node.cell, cone)) return reached(cone);
    for (const HeadingArc& arc : own.arcs())
      if (reached(HeadingCone(HeadingSet({arc})))) return true;
    return false;
  }

  void expand(int k, double spent) {
    const Cell cell = nodes_[static_cast<std::size_t>(k)].cell;
    const HeadingSet& own = headings_.of(map_.at(cell));
    const HeadingCone cone(own);
    if (!byArcs(cell, cone)) return expandBy(k, spent, cone, -1);
    for (std::size_t arc = 0; arc < own.arcs().size(); ++arc)
      expandBy(k, spent, HeadingCone(HeadingSet({own.arcs()[arc]})), static_cast<int>(arc));
  }

  void expandBy(int k, double spent, const HeadingCone& cone, int arc) {
    const Node node = nodes_[static_cast<std::size_t>(k)];
    const HeadingSet& own = headings_.of(map_.at(node.cell));
    const auto [a, b] = ends(node);
    const InCell middle = 0.5 * (a + b);
    for (int side = 0; side < 4; ++side) {
      const Cell next = beyond(node.cell, side);
      if (!map_.grid().contains(next) || (limits_.may_enter && !limits_.may_enter(next))) continue;
      const auto heading = crossing(own, headings_.of(map_.at(next)), side);
      if (!heading) continue;
      SideRange range = cone.reached(a, b, side, node.side < 0 ? extent_.ends : extent_.margins.slack);
      range = {std::max(range.from, extent_.margins.apart), std::min(range.to, 1.0 - extent_.margins.apart)};
      if (range.empty()) continue;
      if (onlyCorner(range)) {
        overCorner(k, spent, cone, side, range.from > 0.5);
        continue;
      }
      const InCell leg = onSide(side, 0.5 * (range.from + range.to)) - middle;
      const double metres = map_.grid().resolution_m * std::max(0.05, std::hypot(leg.x, leg.y));
      const double price =
          map_.cost().costPerMetre(map_.at(node.cell), {std::cos(*heading), std::sin(*heading)});
      open({next, otherSide(side), range, k, arc}, spent + metres * (std::isfinite(price) ? price : 1.0));
    }
  }

  static constexpr double kCorner = 1e-12;  // sides: rounding
  static bool onlyCorner(const SideRange& range) noexcept {
    return range.to <= kCorner || range.from >= 1.0 - kCorner;
  }

  // Handles a cell side of which only the end corner is reached. A drive passes the corner if it arrives on the
  // first or last heading of the cone and all cells around the corner permit the heading. The search
  // continues in each cell into which such a heading leads.
  void overCorner(int k, double spent, const HeadingCone& cone, int side, bool at_end) {
    const Node node = nodes_[static_cast<std::size_t>(k)];
    const bool meridian = side == Side::West || side == Side::East;
    const int beside = meridian ? (at_end ? Side::North : Side::South) : (at_end ? Side::East : Side::West);
    const Cell across = beyond(node.cell, side), next = beyond(node.cell, beside),
               far = beyond(across, beside);
    HeadingSet all = headings_.of(map_.at(node.cell));
    for (const Cell other : {across, next, far})
      if (map_.grid().contains(other)) all = all.shared(headings_.of(map_.at(other)));
    if (all.empty() || !comesOver(node, cone, all, onSide(side, at_end ? 1.0 : 0.0), side, beside)) return;
    if (!corners_.insert(4 * map_.grid().index(node.cell) + (side < 2 ? 0 : 2) + (at_end ? 1 : 0)).second)
      return;
    const SideRange along_side = at_end ? SideRange{1.0, 1.0} : SideRange{0.0, 0.0};
    const SideRange along_beside = side % 2 == 1 ? SideRange{1.0, 1.0} : SideRange{0.0, 0.0};
    open({across, otherSide(side), along_side, k}, spent);
    open({next, otherSide(beside), along_beside, k}, spent);
    if (map_.grid().contains(far))
      open({far, otherSide(side), along_side.from > 0.5 ? SideRange{0.0, 0.0} : SideRange{1.0, 1.0}, k},
           spent);
  }

  bool comesOver(const Node& node, const HeadingCone& cone, const HeadingSet& all, InCell corner, int side,
                 int beside) const {
    const auto [a, b] = ends(node);
    for (const double heading : cone.ends_rad()) {
      if (std::abs(std::remainder(all.nearest(heading, 0.0) - heading, HeadingSet::kTurn)) > 1e-6) continue;
      if (std::cos(heading - outwards_rad(side)) < -1e-6 || std::cos(heading - outwards_rad(beside)) < -1e-6)
        continue;
      const InCell before{corner.x - 1e-3 * std::cos(heading), corner.y - 1e-3 * std::sin(heading)};
      if (cone.joins(a, b, before, 1e-9)) return true;
    }
    return false;
  }

  // Heading of both sets that is nearest to the outward normal of the side; nothing if no common heading
  // leads out.
  std::optional<double> crossing(const HeadingSet& own, const HeadingSet& other, int side) const {
    const double out = outwards_rad(side);
    if (own.all() && other.all()) return out;
    const HeadingSet both = own.shared(other);
    if (both.empty()) return std::nullopt;
    const double heading = both.nearest(out, extent_.within_rad);
    return std::cos(heading - out) > extent_.outwards ? std::optional(heading) : std::nullopt;
  }

  // Constructs the drive that ends in the cell of a node. On failure, restricts the cell that blocked the
  // drive and returns Blocked, or Exhausted if no restriction is possible.
  End lay(int last) {
    std::vector<ChainLink> chain;
    int arc = -1;
    for (int k = last; k >= 0; k = nodes_[static_cast<std::size_t>(k)].parent) {
      const Node& node = nodes_[static_cast<std::size_t>(k)];
      const HeadingSet& own = headings_.of(map_.at(node.cell));
      chain.push_back({node.cell, node.side,
                       arc < 0 ? own : HeadingSet({own.arcs()[static_cast<std::size_t>(arc)]}),
                       arc < 0 && everywhere(node.cell, HeadingCone(own))});
      arc = node.arc;
    }
    std::ranges::reverse(chain);
    LaidChain laid = laidChain(cost_, chain, places_, tolerance_m_, extent_.margins);
    if (!laid.points.empty()) {
      found_.points = std::move(laid.points);
      return End::Reached;
    }
    const Cell cell = chain[laid.failed].cell;
    Use& use = use_[map_.grid().index(cell)];
    if (use == Use::Never) return End::Exhausted;
    const bool whole = use == Use::Whole && HeadingCone(headings_.of(map_.at(cell))).everywhere();
    use = whole ? Use::OneArc : Use::Never;
    return End::Blocked;
  }

  const MotionCost& cost_;
  const costmap::CostGrid& map_;
  HeadingSets& headings_;
  Segment places_;
  double tolerance_m_;
  const CellRouteLimits& limits_;
  const StopCheck& stop_;
  Extent extent_{};
  bool proof_ = false;
  CellRoute found_{};
  std::vector<bool> passed_;
  std::size_t passed_cells_ = 0;
  std::vector<Node> nodes_;
  std::priority_queue<std::pair<double, int>> queue_;
  std::unordered_map<std::size_t, SideCover> cover_;
  std::unordered_set<std::size_t> corners_;  // corners passed, with their direction
  std::unordered_map<std::size_t, Use> use_;
};

}  // namespace

CellRoute cellRoute(const MotionCost& cost, HeadingSets& headings, const Segment& places, double tolerance_m,
                    const CellRouteLimits& limits, const StopCheck& stop) {
  if (std::isfinite(cost(places))) return {.points = {places.from, places.to}};
  return Search(cost, headings, places, tolerance_m, limits, stop).route();
}

}  // namespace talus::planner
