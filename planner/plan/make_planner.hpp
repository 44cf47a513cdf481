#pragma once

#include <memory>
#include <string>

#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// Creates one of Talus' own planners with default settings; no shared library is loaded. `name` is the name
/// of the planner; an empty name selects the default planner. GlobalPlanner::capabilities().planners contains
/// the names. Throws std::invalid_argument for an unknown name.
std::unique_ptr<GlobalPlanner> makePlanner(const std::string& name = {});

}  // namespace talus::planner
