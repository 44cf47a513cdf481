#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <talus/planner/reach/cell_chain.hpp>
#include <talus/planner/reach/cell_route.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {
namespace {

using maps::Cell;

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
