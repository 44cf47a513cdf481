#pragma once

/// Entry header of talus::simulation: traverse simulations on soil that differs from the planner's map.

#include <talus/planner/planner.hpp>
#include <talus/planner/simulation/drive/simulation_rates.hpp>
#include <talus/planner/simulation/drive/traverse_log.hpp>
