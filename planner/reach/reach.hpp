#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <unordered_map>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/reach/cell_side.hpp>
#include <talus/planner/route/cells_within.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Cells that can be entered by a drive from a place, or from which a drive can reach the place, for any
/// headings and turns. The set is never too small: a cell outside the set is proven to be unreachable.
///
/// Method (ours). Inside a cell a drive can move from a place in all directions that are combinations of the
/// permitted headings (HeadingCone). The drive crosses a side only with a heading permitted in both cells, in
/// the range that the cone reaches from the entry ranges. The ranges of a side are stored as one hull, which
/// is replaced by the complete side after kGrowths growths; growth below 1e-9 of a side is rounding. A drive
/// over a corner also passes the corner of an adjacent cell with the same heading, and a drive along a side
/// belongs to both cells, because MotionCost checks all these cells. Work and memory are proportional to the
/// number of reached cells.
class Reach {
 public:
  enum class Sense { From, To };

  /// Computes the cells reachable from a place inside the map, or the cells from which the place or the
  /// tolerance around it can be reached. With `other`, of the opposite sense over the same cells or fewer,
  /// the computation ends as soon as a common cell connects both.
  Reach(const costmap::CostGrid& map, HeadingSets& headings, Sense sense, maps::Point place,
        double tolerance_m = 0.0, const StopCheck& stop = {}, const Reach* other = nullptr);

  /// Returns true if a drive may enter the cell.
  bool holds(maps::Cell cell) const noexcept {
    return map_.grid().contains(cell) && seen_[map_.grid().index(cell)] != 0;
  }

  /// Returns true if a drive may come within the tolerance of a place.
  bool reaches(maps::Point place, double tolerance_m);

  std::size_t cells() const noexcept { return cells_; }
  /// True if a drive from one place to the place of `other` exists, through a common cell in which every
  /// direction is drivable.
  bool joined() const noexcept { return joined_; }
  /// False after a stop; the set then proves nothing.
  bool complete() const noexcept { return complete_; }

 private:
  // Entries into a cell with a cone: ranges by side, and the place at which the drive began.
  struct Entries {
    std::array<SideRange, 4> sides{};
    bool has_place = false;
    bool anywhere = false;
    InCell place{};
    int growths = 0;
  };

  void begin(maps::Cell cell, const InCell* place);
  void spread(maps::Cell cell);
  SideRange exits(const Entries& entries, const HeadingCone& cone, int side) const noexcept;
  void enter(maps::Cell cell, int side, const SideRange& range);
  void enqueue(std::size_t index);
  const HeadingSet& headingsOf(maps::Cell cell);
  bool mayCross(maps::Cell cell, const HeadingSet& own, int side);

  static constexpr int kGrowths = 64;

  const costmap::CostGrid& map_;
  HeadingSets& headings_;
  Sense sense_;
  std::unordered_map<std::uint32_t, HeadingSet> reversed_;
  std::vector<std::uint8_t> seen_;
  std::unordered_map<std::size_t, Entries> cones_;
  std::deque<std::size_t> open_;
  const Reach* other_;
  std::size_t cells_ = 0;
  bool joined_ = false;
  bool complete_ = true;
};

}  // namespace talus::planner
