#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <unordered_map>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/planner/reach/side_range.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Reachable set: the cells that a drive from a start can enter, or the cells from which a drive can reach a
/// goal, with any headings and turns. The set is never too small: a cell outside the set is proven to be
/// unreachable.
///
/// Method (ours). Inside a cell a drive can move from a point in all directions that are combinations of the
/// permitted headings (HeadingCone). The drive crosses a side only with a heading permitted in both cells,
/// within the range that the cone reaches from the ranges of entry. All ranges of a side are stored as one
/// hull. The hull is replaced by the complete side after kGrowths extensions; extensions below 1e-9 of a side
/// are treated as rounding errors. A drive through a corner also touches the other cells at this corner with
/// the same heading, and a drive along a side belongs to both cells, because MotionCost checks all these
/// cells. Time and memory are proportional to the number of reached cells.
class Reach {
 public:
  /// Direction of the search: from a start, or to a goal.
  enum class Sense { From, To };

  /// Computes the cells reachable from `place`, or the cells from which `place` or a point within
  /// `tolerance_m` of it can be reached. `place` must lie inside the map. `other`, if given, is a reachable
  /// set of the opposite sense over the same cells or a part of them; the computation then ends as soon as a
  /// common cell connects both places. The computation also ends, incomplete, above `most_cells` cells.
  Reach(const costmap::CostGrid& map, HeadingSets& headings, Sense sense, maps::Point place,
        double tolerance_m = 0.0, const StopCheck& stop = {}, const Reach* other = nullptr,
        std::size_t most_cells = std::numeric_limits<std::size_t>::max());

  /// Returns true if the set contains the cell.
  bool holds(maps::Cell cell) const noexcept {
    return map_.grid().contains(cell) && seen_[map_.grid().index(cell)] != 0;
  }

  /// Returns true if the set contains a point within `tolerance_m` of `place`.
  bool reaches(maps::Point place, double tolerance_m);

  /// Returns the number of cells of the set.
  std::size_t cells() const noexcept { return cells_; }
  /// Returns true if a drive exists between the places of this set and of `other`, through a common cell in
  /// which a drive can move in every direction.
  bool joined() const noexcept { return joined_; }
  /// Returns false if a stop or `most_cells` ended the computation; the set then proves nothing.
  bool complete() const noexcept { return complete_; }

 private:
  // Entries into a cell whose permitted directions are a cone: ranges by side, and the point at which the
  // drive begins.
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
  std::unordered_map<std::uint64_t, HeadingSet> reversed_;
  std::vector<std::uint8_t> seen_;
  std::unordered_map<std::size_t, Entries> cones_;
  std::deque<std::size_t> open_;
  const Reach* other_;
  std::size_t cells_ = 0;
  bool joined_ = false;
  bool complete_ = true;
};

}  // namespace talus::planner
