#pragma once

#include <string>
#include <vector>

#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

/// A section of a route that deviates from another route by more than a tolerance.
struct Parting {
  double from_m = 0.0;  ///< distance from the start, along the route
  double to_m = 0.0;
  double most_m = 0.0;  ///< largest distance to the other route
  maps::Point begin, end;
};

/// Sections in which a route deviates from another route. The route is sampled every half tolerance, or in
/// 4000 steps if those are longer.
std::vector<Parting> partings(const planner::Route& route, const planner::Route& other, double tolerance_m);

/// Adds further routes to a scene that contains the first route. Equal facts stay in the facts; differing
/// facts and the sections that deviate from the first route are added to the comparison.
void compare(Scene& scene, std::vector<NamedRoute> routes);

}  // namespace talus::cli
