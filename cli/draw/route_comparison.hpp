#pragma once

#include <string>
#include <vector>

#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// A section in which a route deviates from another route by more than a tolerance.
struct Parting {
  double from_m = 0.0;  ///< begin of the section: distance from the start, along the route
  double to_m = 0.0;
  double most_m = 0.0;  ///< greatest distance to the other route in the section
  maps::Point begin, end;
};

/// Returns the sections in which a route deviates from another route by more than tolerance_m. The route is
/// sampled every half tolerance, or in 4000 steps if these are longer.
std::vector<Parting> partings(const planner::Route& route, const planner::Route& other, double tolerance_m);

/// Adds several routes and their comparison to a scene; the first route is the reference. Facts that are
/// equal for all routes are appended to Scene::facts. Facts that differ, and the sections in which a route
/// deviates from the first route, are appended to Scene::comparison.
void compare(Scene& scene, std::vector<NamedRoute> routes);

}  // namespace talus::cli
