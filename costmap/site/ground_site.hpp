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

/// External cost per metre [J/m] of the ground, for example for shadow or missing radio contact, which is
/// added to the energy. Values are 0 to kMost_J_per_m, or infinite: impassable, or NaN: unknown. A cell with
/// an unknown value is refused as unknown ground, or costs unseen_J_per_m if the policy allows unknown
/// ground.
struct CostLayer {
  static constexpr float kMost_J_per_m = 1e6F;
  static constexpr std::size_t kMostLayers = 64;

  std::string name;
  maps::Raster<float> added_J_per_m;
  float unseen_J_per_m = 0.0F;  ///< at least the greatest known cost: missing data never lowers a cost
};

/// Input of a map: layers on the grid of the elevation; empty layers are absent.
struct MapLayers {
  maps::ElevationMap elevation;
  maps::Raster<std::uint8_t> classes;   ///< terrain-class numbers, 255: no class
  maps::Raster<float> rock_abundance;   ///< fraction of the area covered by rocks, NaN: no data
  maps::Raster<std::uint8_t> keep_out;  ///< non-zero: impassable
  maps::Raster<Hazard> declared;        ///< known hazards, for example of a map file
  Floors floors;                        ///< ground beneath overhangs, from a point cloud
  std::vector<CostLayer> costs{};       ///< costs in addition to those of the rover, each with a name
  /// Base of the height keys [m]; nullopt: middleElevation().
  std::optional<double> base_elevation_m{};
};

/// New observation of a window of the ground, for example by the rover's cameras: layers on one grid aligned
/// with the map's cells; empty layers are absent. Cells without an observation remain unchanged.
struct SurfacePatch {
  maps::Raster<float> elevation_m;      ///< in the map frame; NaN: not observed
  maps::Raster<float> rock_abundance;   ///< fraction of the area covered by rocks, 0 to 1; NaN: not observed
  maps::Raster<std::uint8_t> classes;   ///< terrain-class numbers; 255: not observed
  maps::Raster<std::uint8_t> keep_out;  ///< non-zero: impassable; 0 removes an earlier declaration
};

/// Ground declared impassable: the cells whose centre lies within the radius.
struct RefusedPlace {
  maps::Point place;
  double radius_m = 0.0;
};

/// The ground before any evidence, shared by a map and its evidence. Only the map changes the site.
struct GroundSite {
  static constexpr std::uint8_t kNoClass = 255;  ///< class number of a cell without a class

  maps::ElevationMap elevation;
  maps::Raster<std::uint8_t> classes;  ///< class numbers; empty: all cells have the first class
  SurfaceKeys keys;
  std::shared_ptr<const GroundModel> model;
  Floors floors{};                 ///< floors beneath the elevation, which is the top surface
  std::vector<CostLayer> costs{};  ///< on the grid of the elevation

  const maps::Grid& grid() const noexcept { return elevation.grid(); }
  /// Returns the index of a cell's class in the model's classes, or -1 for a class without a soil.
  int classIndex(maps::Cell cell) const noexcept {
    return classes.empty() ? 0 : model->classIndex(classes[cell]);
  }
  /// The floor beneath the top surface at the height of a wheel; nullopt if the wheel is on the top surface.
  std::optional<Floor> floorAt(maps::Cell cell, double z_m) const noexcept {
    return floors.under(grid().index(cell), z_m, static_cast<double>(elevation.elevation_m[cell]));
  }
};

}  // namespace talus::costmap
