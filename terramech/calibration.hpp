#pragma once

/// Entry header of talus::calibration: the soil, or the pull and category of each row, from a whole table of
/// telemetry.

#include <talus/terramech/calibration/tables/assessment.hpp>
#include <talus/terramech/calibration/tables/estimate_soil.hpp>
#include <talus/terramech/terramech_io.hpp>
