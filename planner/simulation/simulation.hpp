#pragma once

/// Entry header of talus::simulation: traverse simulations over soil that the planner does not know.

#include <talus/planner/planner.hpp>
#include <talus/planner/simulation/drive_log.hpp>
#include <talus/planner/simulation/simulation_rates.hpp>
