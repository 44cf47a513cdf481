#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <talus/costmap/floors.hpp>
#include <talus/costmap/ground_model.hpp>
#include <talus/costmap/surface_cells.hpp>
#include <talus/maps/elevation_map.hpp>

namespace talus::costmap {

/// The ground as it was before anybody drove on it: what a map and its evidence share and never change.
struct GroundSite {
  static constexpr std::uint8_t kNoClass = 255;  ///< class number where the raster leaves a cell out

  maps::ElevationMap elevation;
  maps::Raster<std::uint8_t> classes;  ///< class numbers; empty: all of the first class
  SurfaceKeys keys;
  std::shared_ptr<const GroundModel> model;
  Floors floors{};  ///< beneath the elevation, which is the top surface

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
