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

/// The cells that some drive enters on its way from a place, or from which some drive gets to it, whatever its headings
/// and turns: never too few, so that a place outside is proven to be out of reach.
///
/// How (ours). Within a cell a drive that turns at will gets from a place to every place in the directions that its
/// allowed headings add up to (DriveCone). It crosses a side only on a heading that both cells allow, in the part of the
/// side that this cone reaches from the parts where it came in. Parts of a side are kept as one range, their hull, and
/// taken as whole once they have grown kGrowths times; growth below 1e-9 of a side is rounding. A drive over a corner passes the corner of a cell beside it on the
/// same heading, a drive along a side belongs to both cells: MotionCost asks for all of them. Work and memory are in
/// proportion to the cells reached.
class Reach {
 public:
  enum class Sense { From, To };

  /// From a place inside the map, or to it and all places within the tolerance.
  /// With `other`, of the opposite sense over the same cells or fewer, it ends where a cell of both joins their ways.
  Reach(const costmap::CostGrid& map, HeadingSets& headings, Sense sense, maps::Point place,
        double tolerance_m = 0.0, const StopCheck& stop = {}, const Reach* other = nullptr);

  /// Whether a drive may enter the cell.
  bool holds(maps::Cell cell) const noexcept {
    return map_.grid().contains(cell) && seen_[map_.grid().index(cell)] != 0;
  }

  /// Whether a drive may come within the tolerance of a place.
  bool reaches(maps::Point place, double tolerance_m);

  std::size_t cells() const noexcept { return cells_; }
  /// Whether some drive gets from the one's place to the other's: through a cell that both hold and in which it turns at will.
  bool joined() const noexcept { return joined_; }
  /// False where it was stopped: it proves nothing then.
  bool complete() const noexcept { return complete_; }

 private:
  // Where a cell with a cone was entered: by side, and the place it began at.
  struct Entries {
    std::array<SideRange, 4> sides{};
    bool has_place = false;
    bool anywhere = false;
    InCell place{};
    int growths = 0;
  };

  void begin(maps::Cell cell, const InCell* place);
  void spread(maps::Cell cell);
  SideRange exits(const Entries& entries, const DriveCone& cone, int side) const noexcept;
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
