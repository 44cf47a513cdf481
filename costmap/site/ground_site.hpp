#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/surface/cell_belief.hpp>
#include <talus/costmap/surface/floors.hpp>
#include <talus/costmap/surface/surface_cells.hpp>
#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::costmap {

/// What somebody else knows of the ground, such as shadow, radio or hazards of one's own: joules that a metre costs more,
/// counted as energy, 0 to kMost_J_per_m; infinite: must not be entered. NaN: not known, which refuses the cell as unknown ground
/// or, where the policy allows that, costs unseen_J_per_m.
struct CostLayer {
  static constexpr float kMost_J_per_m = 1e6F;
  static constexpr std::size_t kMostLayers = 64;

  std::string name;
  maps::Raster<float> added_J_per_m;
  float unseen_J_per_m = 0.0F;  ///< at least the dearest known, so that doubt makes nothing cheaper
};

/// What a map is built from; layers on the elevation's grid, empty where nobody gave one.
struct MapLayers {
  maps::ElevationMap elevation;
  maps::Raster<std::uint8_t> classes;   ///< terrain-class numbers, 255 = none there
  maps::Raster<float> rock_abundance;   ///< share of the ground, NaN = none there
  maps::Raster<std::uint8_t> keep_out;  ///< not 0: must not be entered
  maps::Raster<Hazard> declared;        ///< hazards judged elsewhere, as when a map is read back
  Floors floors;                        ///< ground beneath overhangs, where the source is a point cloud
  std::vector<CostLayer> costs{};       ///< what comes on top of the rover's own cost; a name each
  /// From which the keys of heights count [m]; nothing: the middle of the range of heights.
  std::optional<double> base_elevation_m{};
};

/// A window of ground observed anew, as from the rover's own cameras: layers on one grid whose cells are cells of the
/// map, empty where nobody gave one. What was not observed leaves the map as it is.
struct SurfacePatch {
  maps::Raster<float> elevation_m;      ///< in the map's frame; NaN = not observed yet
  maps::Raster<float> rock_abundance;   ///< share of the ground, 0 to 1; NaN = not observed yet
  maps::Raster<std::uint8_t> classes;   ///< terrain-class numbers; 255 = not observed yet
  maps::Raster<std::uint8_t> keep_out;  ///< not 0: must not be entered; 0 lifts what was declared
};

/// Ground that somebody declared impassable: the cells whose centre lies within the radius.
struct RefusedPlace {
  maps::Point place;
  double radius_m = 0.0;
};

/// The ground as it was before anybody drove on it: what a map and its evidence share. Only the map changes it.
struct GroundSite {
  static constexpr std::uint8_t kNoClass = 255;  ///< class number where the raster leaves a cell out

  maps::ElevationMap elevation;
  maps::Raster<std::uint8_t> classes;  ///< class numbers; empty: all of the first class
  SurfaceKeys keys;
  std::shared_ptr<const GroundModel> model;
  Floors floors{};                 ///< beneath the elevation, which is the top surface
  std::vector<CostLayer> costs{};  ///< on the elevation's grid

  const maps::Grid& grid() const noexcept { return elevation.grid(); }
  /// Position of a cell's class in the model's classes, or -1 when it has no soil.
  int classIndex(maps::Cell cell) const noexcept {
    return classes.empty() ? 0 : model->classIndex(classes[cell]);
  }
  /// The floor beneath the top surface that a wheel at this height stands on; nothing where it is on top.
  std::optional<Floor> floorAt(maps::Cell cell, double z_m) const noexcept {
    return floors.under(grid().index(cell), z_m, static_cast<double>(elevation.elevation_m[cell]));
  }
};

}  // namespace talus::costmap
