#pragma once

#include <string>
#include <vector>

#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// A stretch of a route that is farther than a tolerance from another route.
struct Parting {
  double from_m = 0.0;  ///< distance from the start, along the route
  double to_m = 0.0;
  double most_m = 0.0;  ///< greatest distance to the other route
  maps::Point begin, end;
};

/// Where a route parts from another one. The route is looked at every half tolerance, or 4000 times where that is coarser.
std::vector<Parting> partings(const planner::Route& route, const planner::Route& other, double tolerance_m);

/// Puts further routes on a scene that has the first: what is equal stays in the facts, what differs goes into the comparison,
/// with where each parts from the first.
void compare(Scene& scene, std::vector<NamedRoute> routes);

}  // namespace talus::cli
