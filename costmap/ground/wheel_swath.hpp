#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/terramech/contact/rover.hpp>

namespace talus::costmap {

/// Computes the drawbar pull over load [-] of a whole rover whose centre is in a cell, from the ground under
/// all its wheels.
///
/// The wheels of a rigid rover have equal slip, so their pulls add: DP/W (drawbar pull over load) of the
/// rover is the mean over its wheels, each on the weakest cell within its width. The result is the least mean
/// over all positions of the centre within the cell (edges, corners and pose error included) and over 16
/// headings, 11.25 degrees apart, but at most the pull of the cell itself. The standard deviation and the
/// sinkage are the maxima over the cells that a wheel may touch. Immutable.
class WheelSwath {
 public:
  /// For a rover on cells of this size; `pose_error_m` >= 0 widens the positions of the centre.
  WheelSwath(const terramech::Rover& rover, double resolution_m, double pose_error_m);

  /// Returns the greatest column or row offset of the cells that a wheel may touch.
  int reach() const noexcept { return reach_; }

  /// Ground of a cell; class_index < 0: outside the map.
  struct Ground {
    int class_index = -1;
    GroundBelief belief;
    bool unseen = false;  ///< true if the class is unknown and the policy excludes unknown ground
    friend bool operator==(const Ground& a, const Ground& b) noexcept {
      return a.class_index == b.class_index && a.belief.pull.value == b.belief.pull.value &&
             a.belief.pull.std == b.belief.pull.std && a.belief.sinkage.value == b.belief.sinkage.value;
    }
  };

  /// Combined ground of the cells that a wheel may touch.
  struct Judged {
    GroundBelief belief;
    int weakest_class = 0;  ///< class of the weakest ground that a wheel may touch
    bool unseen = false;    ///< true if a wheel may touch unseen ground
  };

  /// Combines the ground around a cell. `around` has (2 reach + 1)^2 cells, row by row from the south-west,
  /// the cell itself in the centre. The central cell must have a class; cells without a class, such as cells
  /// outside the map, have the pull of the central cell.
  Judged judged(const std::vector<Ground>& around) const;

 private:
  using Place = std::uint32_t;           // index of a cell in `around`
  using Footprint = std::vector<Place>;  // cells under a wheel: distinct, ascending
  std::vector<Footprint> stand(const terramech::Rover& rover, const maps::Point& p_map,
                               double heading_rad) const;

  double resolution_m_;
  int reach_ = 0;
  std::size_t wheels_;
  std::size_t across_;             // number of sample points across the width of a wheel
  std::vector<Place> footprints_;  // distinct wheel footprints, across_ cells each, padded with the last cell
  std::vector<std::uint32_t> standings_;  // wheels_ footprint indices for each stance of the rover
  std::vector<Place> touched_;            // cells that any wheel may touch
};

}  // namespace talus::costmap
