#pragma once

#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// Throws std::invalid_argument with the name of the first field of the request that is set but not honoured
/// by a planner of these capabilities, or out of range. Applied to every planner of loadPlugin() and
/// makePlanner().
void requireHonoured(const PlanRequest& request, const PlannerCapabilities& offers);

/// Returns the settings after checking their ranges. Throws std::invalid_argument with field, value and
/// bound.
const PlannerSettings& validated(const PlannerSettings& settings);

}  // namespace talus::planner
