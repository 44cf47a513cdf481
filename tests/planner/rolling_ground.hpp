#pragma once

#include <cmath>
#include <memory>
#include <optional>

#include <talus/planner/planner.hpp>

namespace talus::planner::testing {

inline constexpr double kCell_m = 2.0;
inline const maps::Grid kWhole{
    .width = 700, .height = 500, .resolution_m = kCell_m, .south_west = {100.0, -50.0}};

/// Elevation of undulating ground, independent of the sampled window.
inline float height(maps::Point p) {
  return static_cast<float>(4.0 * std::sin(p.x_m / 60.0) * std::cos(p.y_m / 45.0));
}

inline std::shared_ptr<const costmap::GroundModel> model() {
  terramech::Rover rover;
  rover.name = "micro-rover";
  rover.mass_kg = 90.0;
  rover.wheel = {.radius_m = 0.2, .width_m = 0.2};
  rover.wheelbase_m = 0.9;
  rover.track_m = 0.8;
  rover.clearance_m = 0.2;
  rover.centre_of_mass_height_m = 0.4;
  rover.max_torque_Nm = 60.0;
  const terramech::Soil soil{.name = "firm",
                             .cohesion_Pa = 2000.0,
                             .friction_angle_rad = 0.6,
                             .sinkage_exponent = 1.0,
                             .cohesive_modulus = 1400.0,
                             .frictional_modulus = 2e6,
                             .shear_modulus_m = 0.018};
  static const auto made = std::make_shared<const costmap::GroundModel>(
      costmap::GroundModel::Parts{.rover = rover, .classes = {{.soil = soil}}, .policy = {}});
  return made;
}

inline costmap::TraversabilityMap built(const maps::Grid& grid, float (*height_m)(maps::Point) = height) {
  costmap::MapLayers layers;
  layers.elevation.elevation_m = maps::Raster<float>(grid);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      layers.elevation.elevation_m[{column, row}] = height_m(grid.centre({column, row}));
  return costmap::TraversabilityMap(std::move(layers), model(), {});
}

inline maps::Grid gridOf(const MapBox& box) {
  return {.width = static_cast<int>(std::lround((box.high.x_m - box.low.x_m) / kCell_m)),
          .height = static_cast<int>(std::lround((box.high.y_m - box.low.y_m) / kCell_m)),
          .resolution_m = kCell_m,
          .south_west = box.low};
}

/// The whole map in windows, with an overview in cells five times as large, of
/// other heights; counts the boxes that are built.
inline WindowedMap windows(int& asked, float (*height_m)(maps::Point) = height,
                           float (*overview_m)(maps::Point) = height) {
  maps::Grid coarse = kWhole;
  coarse.width /= 5, coarse.height /= 5, coarse.resolution_m *= 5;
  return WindowedMap({.grid = kWhole,
                      .overview = built(coarse, overview_m).published(),
                      .build = [&asked, height_m](const MapBox& box) {
                        ++asked;
                        return std::optional(built(gridOf(box), height_m));
                      }});
}

}  // namespace talus::planner::testing
