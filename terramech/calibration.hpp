#pragma once

/// Umbrella header of talus::calibration. From a table of wheel telemetry its functions estimate the soil
/// parameters, the drawbar pull and traversability category of each row, and the physical effects that a
/// wheel model lacks.

#include <talus/terramech/calibration/tables/assessment.hpp>
#include <talus/terramech/calibration/tables/estimate_soil.hpp>
#include <talus/terramech/calibration/trace/trace_table.hpp>
#include <talus/terramech/terramech_io.hpp>
