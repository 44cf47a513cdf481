#pragma once

#include <talus/planner/plugin/global_planner.hpp>

namespace talus::planner {

/// Throws std::invalid_argument with the name of the first field of `request` that is out of range, or that
/// is set although a planner with the capabilities `offers` does not support it. Every planner of
/// loadPlugin() and Planner call this function.
void requireHonoured(const PlanRequest& request, const PlannerCapabilities& offers);

/// Returns `settings` after a check of the ranges. Throws std::invalid_argument with field, value and bound.
const PlannerSettings& validated(const PlannerSettings& settings);

}  // namespace talus::planner
