#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/maps.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::costmap {

/// Returns for each cell, by its index in the grid, whether a cell of another terrain class lies within
/// `reach` columns and rows of it. Returns an empty vector for an empty raster.
std::vector<bool> classBorders(const maps::Raster<std::uint8_t>& classes, int reach);

/// Computes the drawbar pull over load DP/W of a whole rover whose centre is in a cell, from the estimated
/// ground under all its wheels.
///
/// The wheels of a rigid rover have equal slip, so their pulls add: DP/W of the rover is the mean over its
/// wheels, where DP/W of a wheel is that of the weakest cell within the wheel's width. The result is the
/// least mean over all positions of the rover's centre within the cell (edges, corners and pose error
/// included) and over 16 headings, 11.25 degrees apart, but at most DP/W of the cell itself. The standard
/// deviation of DP/W and the sinkage of the result are the maxima over all cells that a wheel may touch.
/// Immutable.
class WheelSwath {
 public:
  /// Makes the geometry for a rover on cells with sides of resolution_m [m]. `pose_error_m` >= 0 is the
  /// position error by which the positions of the rover's centre are extended.
  WheelSwath(const terramech::Rover& rover, double resolution_m, double pose_error_m);

  /// Returns the greatest column or row offset between a cell and the cells that a wheel may touch if the
  /// rover's centre is in the cell.
  int reach() const noexcept { return reach_; }

  /// Ground of one cell. class_index is the index of its terrain class in the model; < 0: the cell has no
  /// class, or lies outside the map.
  struct Ground {
    int class_index = -1;
    GroundBelief belief;
    bool unseen = false;  ///< true if the terrain class is unknown and the policy excludes unknown ground
    friend bool operator==(const Ground& a, const Ground& b) noexcept {
      return a.class_index == b.class_index && a.belief.pull.value == b.belief.pull.value &&
             a.belief.pull.std == b.belief.pull.std && a.belief.sinkage.value == b.belief.sinkage.value;
    }
  };

  /// Ground of the whole rover, combined from the cells that a wheel may touch.
  struct Judged {
    GroundBelief belief;
    int weakest_class = 0;  ///< terrain class of the weakest ground that a wheel may touch
    bool unseen = false;    ///< true if a wheel may touch a cell with Ground::unseen
  };

  /// Returns the combined ground for the rover's centre in a cell. `around` contains the ground of (2 reach()
  /// + 1)^2 cells, row by row from the south-west, with the cell itself in the middle. The middle cell must
  /// have a class. For cells without a class, such as cells outside the map, the drawbar pull over load DP/W
  /// of the middle cell is used.
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
