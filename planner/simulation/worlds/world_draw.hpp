#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/planner/simulation/worlds/true_world.hpp>

namespace talus::planner {

/// True soils of a site and their variation between worlds (random draws of the soils). Plain data.
struct Truth {
  /// True soils by class number, where they differ from the soils of the map.
  std::map<int, terramech::Soil> classes;
  std::vector<SoilPatch> patches;  ///< soil patches that are present in every world
  /// Relative standard deviation of cohesion, tangent of the friction angle and moduli [-].
  double spread = 0.0;
  /// True: the ground of each class departs from its soil as the map believes (GroundClass::mean_std and
  /// pull_std, correlation length of 5 m).
  bool as_believed = false;
  /// Number of random patches drawn per world; patches near start or goal are then omitted.
  int random_patches = 0;
  double patch_radius_m = 3.0;  ///< mean radius of random patches, > 0; radii are uniform within +-50 %
  terramech::Soil patch_soil;   ///< soil of the random patches, varied by `spread`
  std::vector<terramech::Effect> effects{};  ///< effects on all soils that the map does not declare
  bool second_slip = true;  ///< true: the rover measures a second slip by its speeds (SensorOptions)
};

/// Seed of the random draw of a world, and positions that stay free of random patches.
struct WorldDraw {
  std::uint64_t seed = 1;  ///< seed of the random draw
  maps::Point start;       ///< start of the drive, free of random patches [m]
  maps::Point goal;        ///< goal of the drive, free of random patches [m]
};

/// Returns the soils of one world on `grid`; the soils of terrain classes have the order of `classes`. Equal
/// draws give equal worlds. The soil of a class does not depend on the other classes, nor do the random
/// patches.
WorldSoils drawWorld(const Truth& truth, const std::vector<costmap::GroundClass>& classes,
                     const maps::Grid& grid, const WorldDraw& draw);

}  // namespace talus::planner
