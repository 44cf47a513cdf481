#pragma once

#include <talus/cli/draw/scene.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::cli {

/// Hills over 120 x 80 cells of 5 m, with a hole in the data.
maps::ElevationMap exampleMap();

/// A route of 61 vertices across the hills.
planner::Route exampleRoute();

/// The map and the route, with categories.
Scene exampleScene();

/// Writes the picture to the folder named by the environment variable TALUS_TEST_PICTURES, if set, for
/// inspection.
void keep(const std::string& name, const std::string& bytes);

}  // namespace talus::cli
