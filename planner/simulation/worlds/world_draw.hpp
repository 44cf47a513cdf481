#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/planner/simulation/worlds/true_world.hpp>

namespace talus::planner {

/// True soils of a site and their variation from world to world. Plain data.
struct Truth {
  std::map<int, terramech::Soil> classes;  ///< true soils that differ from those of the map
  std::vector<SoilPatch> patches;          ///< present in every world
  double spread = 0.0;     ///< relative standard deviation of cohesion, tangent of the friction angle and
                           ///< moduli [-]
  int random_patches = 0;  ///< random patches drawn per world; patches near start or goal are omitted
  double patch_radius_m = 3.0;               ///< mean radius; uniform within +-50 %
  terramech::Soil patch_soil;                ///< soil of the random patches, varied like the classes
  std::vector<terramech::Effect> effects{};  ///< undeclared effects on all soils
};

/// Seed of a world, and the places kept free of random patches.
struct WorldDraw {
  std::uint64_t seed = 1;  ///< world seed
  maps::Point start;       ///< kept free of random patches [m]
  maps::Point goal;        ///< kept free of random patches [m]
};

/// Soils of one world on a grid, in the order of the classes. Equal draws give equal worlds; the soils of a
/// class and of the random patches do not depend on the other classes.
WorldSoils drawWorld(const Truth& truth, const std::vector<costmap::GroundClass>& classes,
                     const maps::Grid& grid, const WorldDraw& draw);

}  // namespace talus::planner
