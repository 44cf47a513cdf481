#pragma once

/// Entry header of talus::calibration: the soil, the pull and category of each row, or the effects that a model lacks, from
/// a whole table of telemetry.

#include <talus/terramech/calibration/tables/assessment.hpp>
#include <talus/terramech/calibration/tables/estimate_soil.hpp>
#include <talus/terramech/calibration/trace/trace_table.hpp>
#include <talus/terramech/terramech_io.hpp>
