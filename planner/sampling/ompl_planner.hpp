#pragma once

#include <cstdint>
#include <map>
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
  std::map<std::string, std::string> parameters{};  ///< checkParameters() takes them
};

/// A planner of plannerNames(), set up with the settings that suit this ground; a null pointer for "field".
ompl::base::PlannerPtr makeOmplPlanner(const std::string& name, const PlannerParts& parts);

/// Whether a name is that of one of OMPL's planners.
bool isOmpls(const std::string& name);

/// Throws std::invalid_argument for a planner that is not OMPL's, for an unknown parameter, and for a value out of its range.
void checkParameters(const std::string& name, const std::map<std::string, std::string>& parameters);

}  // namespace talus::planner
