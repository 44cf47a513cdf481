#pragma once

#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// Throws std::invalid_argument naming the first field of the request that is set and that a planner of these
/// capabilities does not honour, or that leaves its range. Every planner that loadPlugin() or makePlanner()
/// gives is asked through it.
void requireHonoured(const PlanRequest& request, const PlannerCapabilities& offers);

/// The settings, once they keep their ranges. Throws std::invalid_argument naming field, value and bound.
const PlannerSettings& validated(const PlannerSettings& settings);

}  // namespace talus::planner
