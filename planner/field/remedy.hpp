#pragma once

#include <string>

#include <talus/planner/field/edge_layer.hpp>

namespace talus::planner {

/// One line for a place that no route may begin or end at: why, and the nearest place that will do.
/// `which` is "start" or "goal".
std::string invalidPlace(const costmap::CostGrid& map, const std::string& which, maps::Point place);

/// One line for two places that nothing connects: how much ground the start reaches, and the place there
/// nearest to the goal.
std::string noWay(const EdgeLayer& edges, maps::Point start, maps::Point goal);

}  // namespace talus::planner
