#pragma once

#include <memory>
#include <string>

#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// One of Talus' own planners, without a shared library: the default, or the one of that name, configured
/// with default settings; capabilities().planners lists the names. Throws std::invalid_argument for a name
/// that is not on offer.
std::unique_ptr<GlobalPlanner> makePlanner(const std::string& name = {});

}  // namespace talus::planner
