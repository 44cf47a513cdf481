#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/terramech/contact/rover.hpp>

namespace talus::costmap {

/// Where the wheels of a rover may stand while its middle is in a cell: the ground of a cell is judged by what
/// all wheels together can pull there, not by the soil of a point.
///
/// The wheels of a rigid rover slip alike, so that their pulls add up: the pull over load of the rover is the
/// mean over its wheels, each on the weakest cell that its width touches. Of all places of the middle within the
/// cell, its edges and corners and the pose error around them, and of all headings (16, 11.25 degrees apart,
/// turns in place included), the least mean counts, or that of the cell's own ground if it is less. Doubt and
/// sinkage are the greatest of any cell that a wheel may touch. Immutable.
class WheelSwath {
 public:
  /// The rover on cells of this size; its middle may be off by as much as the pose error [m], >= 0.
  WheelSwath(const terramech::Rover& rover, double resolution_m, double pose_error_m);

  /// Cells that a wheel may touch lie at most so many columns and rows away.
  int reach() const noexcept { return reach_; }

  /// Ground of a cell; class_index < 0: outside of the map.
  struct Ground {
    int class_index = -1;
    GroundBelief belief;
    bool unseen = false;  ///< no class is known of it, and the policy does not allow that
    friend bool operator==(const Ground& a, const Ground& b) noexcept {
      return a.class_index == b.class_index && a.belief.pull.value == b.belief.pull.value &&
             a.belief.pull.std == b.belief.pull.std && a.belief.sinkage.value == b.belief.sinkage.value;
    }
  };

  /// What the swath makes of the ground around a cell.
  struct Judged {
    GroundBelief belief;
    int weakest_class = 0;  ///< of the weakest ground that a wheel may touch
    bool unseen = false;    ///< whether a wheel may touch ground that is
  };

  /// `around`: the ground of (2 reach + 1)^2 cells, row by row from the south-west, the cell in the middle; that
  /// must have a class, and what lies outside of the map counts as it.
  Judged judged(const std::vector<Ground>& around) const;

 private:
  using Place = std::uint32_t;           // of a cell in `around`
  using Footprint = std::vector<Place>;  // of a wheel: each cell once, ascending
  std::vector<Footprint> stand(const terramech::Rover& rover, const maps::Point& middle,
                               double heading_rad) const;

  double resolution_m_;
  int reach_ = 0;
  std::size_t wheels_;
  std::size_t across_;                    // places that the width of a wheel is looked at
  std::vector<Place> footprints_;         // of a wheel somewhere, across_ places each, the last one repeated
  std::vector<std::uint32_t> standings_;  // wheels_ footprints each, by number
  std::vector<Place> touched_;            // by any wheel
};

}  // namespace talus::costmap
