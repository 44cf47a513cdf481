#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <ompl/base/Planner.h>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// What one of OMPL's planners is made from.
struct PlannerParts {
  ompl::base::SpaceInformationPtr space;
  ompl::base::ProblemDefinitionPtr definition;
  std::vector<maps::Point> known_route;  ///< may be empty
  double range_m = 1.0;                  ///< longest motion, > 0
  std::uint64_t seed = 1;
};

/// A planner of plannerNames(), set up with the settings that suit this ground; a null pointer for "field".
ompl::base::PlannerPtr makeOmplPlanner(const std::string& name, const PlannerParts& parts);

}  // namespace talus::planner
