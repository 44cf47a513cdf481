#pragma once

#include <cstdint>
#include <memory_resource>
#include <new>
#include <optional>
#include <unordered_map>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>

namespace talus::planner {

/// A closed interval of headings, counter-clockwise.
struct HeadingArc {
  double from_rad = 0.0;   ///< counter-clockwise from x, [0, 2 pi)
  double width_rad = 0.0;  ///< [0, 2 pi]
};

/// A set of headings: closed, disjoint arcs in order of their beginnings.
class HeadingSet {
 public:
  HeadingSet() = default;
  /// Arcs in any order, which may overlap, each in the ranges of HeadingArc.
  explicit HeadingSet(std::vector<HeadingArc> arcs);
  /// A copy with its arcs in memory of the resource, which must outlive the copy.
  HeadingSet(const HeadingSet& other, std::pmr::memory_resource* memory) : arcs_(other.arcs_, memory) {}

  const std::pmr::vector<HeadingArc>& arcs() const noexcept { return arcs_; }
  bool empty() const noexcept { return arcs_.empty(); }
  bool all() const noexcept { return arcs_.size() == 1 && arcs_[0].width_rad >= kTurn; }

  /// Widest gap between arcs: its width, and the end of the arc clockwise of it. Combinations of headings of
  /// the set yield every direction if the gap is narrower than half a turn; otherwise the directions from
  /// `end + gap` counter-clockwise to `end`. The set must not be empty.
  struct Gap {
    double end_rad;
    double width_rad;
  };
  Gap widestGap() const noexcept;

  /// Intersection of two sets.
  HeadingSet shared(const HeadingSet& other) const;

  /// Returns the heading of the set nearest to `heading_rad`, at least `inside_rad` from the ends of its arc,
  /// or in the middle of a narrower arc. The set must not be empty.
  double nearest(double heading_rad, double inside_rad) const noexcept;

  /// The opposite headings.
  HeadingSet reversed() const;

  static constexpr double kTurn = 6.283185307179586;

 private:
  std::pmr::vector<HeadingArc> arcs_;
};

/// Cache of allowedHeadings() by cell code. Cells of curve index `free`, if given, permit every heading.
/// Large maps have millions of codes; their sets are allocated in an arena, which is freed at once. Not
/// thread-safe; the TravelCost must outlive the object.
class HeadingSets {
 public:
  explicit HeadingSets(const costmap::TravelCost& cost, std::optional<std::uint8_t> free = {})
      : cost_(cost),
        free_(free),
        sets_(*new (arena_.allocate(sizeof(Sets), alignof(Sets))) Sets(&arena_)),
        limits_(cost.curves().size()),
        gentle_(cost.curves().size()),
        recent_(kRecent) {}
  HeadingSets(const HeadingSets&) = delete;
  HeadingSets& operator=(const HeadingSets&) = delete;
  const HeadingSet& of(costmap::CellCode cell) {
    if (cell.curve() < gentle_.size() &&
        cell.dzDx() * cell.dzDx() + cell.dzDy() * cell.dzDy() < gentle_[cell.curve()])
      return all_;
    Recent& recent = recent_[(cell.bits() * 2654435761U) >> 20];  // multiplicative hashing to kRecent slots
    if (recent.set != nullptr && recent.bits == cell.bits()) return *recent.set;
    const HeadingSet& set = known(cell);
    recent = {cell.bits(), &set};
    return set;
  }

  /// Gradients along, and magnitudes of gradients across, at which the cost of a curve may become finite or
  /// infinite.
  struct Limits {
    Limits(const costmap::TravelCost& cost, const costmap::TravelCurve& curve);
    std::vector<double> along, across;
    /// All headings are permitted on cells below this gradient; 0: on no cell.
    double gentle;
  };

 private:
  // Cell code and heading set of a recent request, because neighbouring cells are requested repeatedly. Sets
  // in sets_ keep their address.
  struct Recent {
    std::uint32_t bits = 0;
    const HeadingSet* set = nullptr;
  };
  static constexpr std::size_t kRecent = 4096;

  const HeadingSet& known(costmap::CellCode cell);

  using Sets = std::pmr::unordered_map<std::uint32_t, HeadingSet>;

  const costmap::TravelCost& cost_;
  std::optional<std::uint8_t> free_;
  std::pmr::monotonic_buffer_resource arena_;
  Sets& sets_;  // allocated in the arena and never destroyed: destruction delayed a stopped plan by 0.5 s
  std::vector<std::optional<Limits>> limits_;
  std::vector<double> gentle_;  // squared Limits::gentle of each curve; 0 until computed
  const HeadingSet all_{{{0.0, HeadingSet::kTurn}}};
  std::vector<Recent> recent_;
};

/// Headings for which the drive cost of a cell is finite. Between two adjacent headings at which the gradient
/// along or across passes a node of the cost table, the cost is either finite or infinite; one evaluation
/// between each pair and one at each heading are sufficient. Arcs are widened by 1e-7 rad, so that rounding
/// excludes no permitted heading.
HeadingSet allowedHeadings(const costmap::TravelCost& cost, costmap::CellCode cell);
HeadingSet allowedHeadings(const costmap::TravelCost& cost, costmap::CellCode cell,
                           const HeadingSets::Limits& limits);

}  // namespace talus::planner
