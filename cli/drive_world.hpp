#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include <costmap/traversability_map.hpp>
#include <planner/true_world.hpp>

namespace talus::cli {

/// TRUTH.yaml: {classes: {1: SOIL, ...}, patches: [{x_m, y_m, radius_m, soil}], random: {spread, patches,
/// patch_radius_m, patch_soil}}. `classes` are the true soils where they differ from what the map believes;
/// `random` varies them from world to world: each soil's cohesion, tangent of friction and moduli by a
/// relative normal spread, and so many undeclared soft patches at random places.
struct Truth {
  std::map<int, terramech::Soil> classes;
  std::vector<planner::SoilPatch> patches;
  double spread = 0.0;          ///< [-]
  int random_patches = 0;       ///< a world
  double patch_radius_m = 3.0;  ///< mean; they range over +-50 %
  terramech::Soil patch_soil;   ///< of the random patches
};

/// Reads a truth file. Throws InputError.
Truth readTruth(const std::string& path);

/// What draws a world: the places that patches may cover, and the number that it is drawn with.
struct WorldDraw {
  std::uint64_t seed = 1;
  maps::Point keep_start;  ///< patches spare start and goal
  maps::Point keep_goal;
};

/// Soils of one world on a map, in the order of its classes.
planner::WorldSoils drawWorld(const Truth& truth, const costmap::TraversabilityMap& map,
                              const WorldDraw& draw);

}  // namespace talus::cli
