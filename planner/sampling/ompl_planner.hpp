#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <ompl/base/Planner.h>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// Input of makeOmplPlanner().
struct PlannerParts {
  ompl::base::SpaceInformationPtr space;
  ompl::base::ProblemDefinitionPtr definition;
  std::vector<maps::Point> known_route;  ///< may be empty
  double range_m = 1.0;                  ///< longest motion, > 0
  std::uint64_t seed = 1;
  std::map<std::string, std::string> parameters{};  ///< must pass checkParameters()
};

/// Creates an OMPL planner of plannerNames() with settings for drive costs; null if the name is not OMPL's.
ompl::base::PlannerPtr makeOmplPlanner(const std::string& name, const PlannerParts& parts);

/// Returns true if the name is that of an OMPL planner.
bool isOmpls(const std::string& name);

/// Throws std::invalid_argument for a planner that is not OMPL's, for an unknown parameter, and for an
/// invalid value.
void checkParameters(const std::string& name, const std::map<std::string, std::string>& parameters);

}  // namespace talus::planner
