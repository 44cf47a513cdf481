#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/grid/grid.hpp>
#include <talus/planner/simulation/worlds/true_world.hpp>

namespace talus::planner {

/// What is true of a site's soils and how they vary from world to world. Plain data.
struct Truth {
  std::map<int, terramech::Soil> classes;  ///< true soils where they differ from what the map believes
  std::vector<SoilPatch> patches;          ///< in every world
  double spread = 0.0;     ///< relative standard deviation of cohesion, tangent of friction and moduli [-]
  int random_patches = 0;  ///< undeclared, a world
  double patch_radius_m = 3.0;               ///< mean; they range evenly over +-50 %
  terramech::Soil patch_soil;                ///< of the random patches, varied as the classes are
  std::vector<terramech::Effect> effects{};  ///< undeclared, on all soils
};

/// What draws a world: its number, and the places that random patches spare.
struct WorldDraw {
  std::uint64_t seed = 1;
  maps::Point start;
  maps::Point goal;
};

/// Soils of one world over a grid, in the order of the classes. Same draw, same world; what a class and the random patches are
/// like does not depend on which other classes there are.
WorldSoils drawWorld(const Truth& truth, const std::vector<costmap::GroundClass>& classes,
                     const maps::Grid& grid, const WorldDraw& draw);

}  // namespace talus::planner
