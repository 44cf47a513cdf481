#pragma once

#include <memory>
#include <string>

#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// Creates one of Talus' own planners with default settings, without a shared library: the planner of the
/// given name, or the default if empty. capabilities().planners lists the names. Throws std::invalid_argument
/// for an unknown name.
std::unique_ptr<GlobalPlanner> makePlanner(const std::string& name = {});

}  // namespace talus::planner
