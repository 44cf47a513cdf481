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
  /// Vertices of a known route from start to goal; empty if none is known.
  std::vector<maps::Point> known_route;
  double range_m = 1.0;    ///< length of the longest motion that is added to a tree, > 0
  std::uint64_t seed = 1;  ///< seed of the random samples
  /// Parameters of the planner; checkParameters() must accept them.
  std::map<std::string, std::string> parameters{};
};

/// Creates the planner of OMPL with a name of plannerNames(), with settings for drive costs; null if the name
/// is not that of an OMPL planner.
ompl::base::PlannerPtr makeOmplPlanner(const std::string& name, const PlannerParts& parts);

/// Returns true if the name is that of an OMPL planner.
bool isOmpls(const std::string& name);

/// Throws std::invalid_argument if `name` is not that of an OMPL planner, for an unknown parameter, and for
/// an invalid value.
void checkParameters(const std::string& name, const std::map<std::string, std::string>& parameters);

}  // namespace talus::planner
