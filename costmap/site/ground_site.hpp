#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/costmap/surface/surface.hpp>
#include <talus/maps/maps.hpp>

namespace talus::costmap {

/// External cost per metre [J/m] of the ground of each cell, which is added to the energy, e.g. for shadow or
/// missing radio contact. Finite values are 0 to kMost_J_per_m. An infinite value means impassable, and NaN
/// means unknown. A cell with an unknown value is refused as unknown ground, or has the cost unseen_J_per_m
/// if the policy allows unknown ground.
struct CostLayer {
  static constexpr float kMost_J_per_m = 1e6F;
  /// Greatest number of cost layers of a map.
  static constexpr std::size_t kMostLayers = 64;

  /// Name of the layer.
  std::string name;
  /// External cost of each cell.
  maps::Raster<float> added_J_per_m;
  /// Cost of cells with an unknown value, at least the greatest known cost: missing data never lowers a cost.
  float unseen_J_per_m = 0.0F;
};

/// Input of a map: layers on the grid of the elevation. A layer that is absent is an empty raster.
struct MapLayers {
  maps::ElevationMap elevation;
  maps::Raster<std::uint8_t> classes;  ///< terrain-class number of each cell; 255: no class
  /// Fraction of the area of each cell that is covered by rocks; NaN: no data [-].
  maps::Raster<float> rock_abundance;
  maps::Raster<std::uint8_t> keep_out;  ///< non-zero: impassable
  maps::Raster<Hazard> declared;        ///< known hazards of each cell, e.g. from a map file
  std::vector<CostLayer> costs{};       ///< external costs, in addition to the costs of driving
  /// Elevation [m] from which the octree counts heights; nullopt: middleElevation().
  std::optional<double> base_elevation_m{};
};

/// New observation of a window (rectangle) of the ground, e.g. by the rover's cameras. All layers are on one
/// grid, which must be aligned with the cells of the map. A layer that is absent is an empty raster. Cells
/// without an observation remain unchanged.
struct SurfacePatch {
  maps::Raster<float> elevation_m;  ///< elevation in the map frame; NaN: not observed
  /// Fraction of the area covered by rocks, 0 to 1; NaN: not observed [-].
  maps::Raster<float> rock_abundance;
  maps::Raster<std::uint8_t> classes;   ///< terrain-class numbers; 255: not observed
  maps::Raster<std::uint8_t> keep_out;  ///< non-zero: impassable; 0 removes an earlier declaration
};

/// Ground declared impassable: the cells whose centre lies within radius_m [m] of `place`.
struct RefusedPlace {
  maps::Point place;
  double radius_m = 0.0;
  std::uint16_t drive = 0;  ///< number of the drive that declared the place; 0: none
};

/// Ground of a map before any evidence from wheels, shared by the map and its evidence. Only the map changes
/// the site.
struct GroundSite {
  static constexpr std::uint8_t kNoClass = 255;  ///< class number of a cell without a class

  maps::ElevationMap elevation;
  /// Terrain-class number of each cell; empty: all cells have the first class of the model.
  maps::Raster<std::uint8_t> classes;
  /// Octree keys of the cells.
  SurfaceKeys keys;
  std::shared_ptr<const GroundModel> model;
  std::vector<CostLayer> costs{};  ///< external costs, on the grid of the elevation

  const maps::Grid& grid() const noexcept { return elevation.grid(); }
  /// Returns the index of a cell's terrain class in the classes of the model; -1 for a class without a soil.
  int classIndex(maps::Cell cell) const noexcept {
    return classes.empty() ? 0 : model->classIndex(classes[cell]);
  }
};

}  // namespace talus::costmap
