#pragma once

#include <cstdint>
#include <memory_resource>
#include <new>
#include <optional>
#include <unordered_map>
#include <vector>

#include <talus/costmap/cost/drive_cost.hpp>

namespace talus::planner {

/// Headings from one to another, both included, counter-clockwise.
struct HeadingArc {
  double from_rad = 0.0;   ///< counter-clockwise from x, [0, 2 pi)
  double width_rad = 0.0;  ///< [0, 2 pi]
};

/// A set of headings: closed arcs in order of their beginnings that do not touch.
class HeadingSet {
 public:
  HeadingSet() = default;
  /// Arcs in any order that may touch, each in the ranges of HeadingArc.
  explicit HeadingSet(std::vector<HeadingArc> arcs);
  /// A copy whose arcs lie in memory of the resource, which must outlive it.
  HeadingSet(const HeadingSet& other, std::pmr::memory_resource* memory) : arcs_(other.arcs_, memory) {}

  const std::pmr::vector<HeadingArc>& arcs() const noexcept { return arcs_; }
  bool empty() const noexcept { return arcs_.empty(); }
  bool all() const noexcept { return arcs_.size() == 1 && arcs_[0].width_rad >= kTurn; }

  /// The arc that lies clockwise of the widest gap between arcs, to its end, and that gap's width: the headings of a
  /// drive that turns within the set add up to every direction if the gap is narrower than half a turn, else to
  /// those from `end + gap` counter-clockwise to `end`. The set must not be empty.
  struct Gap {
    double end_rad;
    double width_rad;
  };
  Gap widestGap() const noexcept;

  /// The headings of both sets.
  HeadingSet shared(const HeadingSet& other) const;

  /// The heading of the set, at least `inside_rad` from the ends of its arc or in the arc's middle, that is nearest to
  /// one given. The set must not be empty.
  double nearest(double heading_rad, double inside_rad) const noexcept;

  /// The headings opposite to these.
  HeadingSet reversed() const;

  static constexpr double kTurn = 6.283185307179586;

 private:
  std::pmr::vector<HeadingArc> arcs_;
};

/// allowedHeadings() of cells, kept by code; cells of the curve number `free`, if any, allow every heading. A large map has
/// millions of codes: their sets lie in an arena, which is freed at once. Not thread-safe; the DriveCost must outlive it.
class HeadingSets {
 public:
  explicit HeadingSets(const costmap::DriveCost& cost, std::optional<std::uint8_t> free = {})
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
    Recent& recent = recent_[(cell.bits() * 2654435761U) >> 20];  // multiplicative hashing, kRecent values
    if (recent.set != nullptr && recent.bits == cell.bits()) return *recent.set;
    const HeadingSet& set = known(cell);
    recent = {cell.bits(), &set};
    return set;
  }

  /// Gradients along, and sizes of gradients across, at which a curve's cost may become finite or infinite.
  struct Limits {
    Limits(const costmap::DriveCost& cost, const costmap::DriveCurve& curve);
    std::vector<double> along, across;
    /// On cells less steep than this all headings are allowed; 0: on none.
    double gentle;
  };

 private:
  // A code and its set, which stays where it is in sets_: neighbouring cells are asked for again and again.
  struct Recent {
    std::uint32_t bits = 0;
    const HeadingSet* set = nullptr;
  };
  static constexpr std::size_t kRecent = 4096;

  const HeadingSet& known(costmap::CellCode cell);

  using Sets = std::pmr::unordered_map<std::uint32_t, HeadingSet>;

  const costmap::DriveCost& cost_;
  std::optional<std::uint8_t> free_;
  std::pmr::monotonic_buffer_resource arena_;
  Sets&
      sets_;  // with all that it holds in the arena, and never destroyed: that took 0.5 s of a plan that was stopped
  std::vector<std::optional<Limits>> limits_;
  std::vector<double> gentle_;  // Limits::gentle of each curve, squared; 0 until the curve was asked for
  const HeadingSet all_{{{0.0, HeadingSet::kTurn}}};
  std::vector<Recent> recent_;
};

/// Every heading for which the drive cost of a cell is finite. Between two neighbouring headings at which the gradient
/// along or across passes a node of the cost's table, the cost is finite or infinite throughout; so it is enough to ask
/// once between each two, and at each. Arcs are widened by 1e-7 rad: no heading is missed by rounding.
HeadingSet allowedHeadings(const costmap::DriveCost& cost, costmap::CellCode cell);
HeadingSet allowedHeadings(const costmap::DriveCost& cost, costmap::CellCode cell,
                           const HeadingSets::Limits& limits);

}  // namespace talus::planner
