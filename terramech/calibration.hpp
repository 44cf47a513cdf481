#pragma once

/// Entry header of talus::calibration. From a table of telemetry: soil parameters, drawbar pull and category
/// of each row, or the effects missing in a model.

#include <talus/terramech/calibration/tables/assessment.hpp>
#include <talus/terramech/calibration/tables/estimate_soil.hpp>
#include <talus/terramech/calibration/trace/trace_table.hpp>
#include <talus/terramech/terramech_io.hpp>
