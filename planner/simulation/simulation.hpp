#pragma once

/// Umbrella header of talus::simulation: simulated drives of a rover on true soils that may differ from the
/// soils of the planner's map.

#include <talus/planner/planner.hpp>
#include <talus/planner/simulation/drive/simulation_rates.hpp>
#include <talus/planner/simulation/drive/traverse_log.hpp>
