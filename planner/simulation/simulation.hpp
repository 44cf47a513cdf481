#pragma once

/// Entry header of talus::simulation: traverse simulations over soil that the planner does not know.

#include <talus/planner/planner.hpp>
#include <talus/planner/simulation/drive/drive_log.hpp>
#include <talus/planner/simulation/drive/simulation_rates.hpp>
