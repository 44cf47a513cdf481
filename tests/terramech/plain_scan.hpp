#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// What an analyst does first, for comparison with tracing: the soil is fitted, then each column in turn is tried on the
/// residual of each channel as a line, a spline of four knots and a mean of each level, by cross-validation over whole
/// runs. The greatest relative reduction of the squared error is taken where it exceeds a twentieth and three standard
/// errors over the runs; it is subtracted and the scan repeated. Returns the columns, at most three.
std::vector<std::string> plainScan(const RefinedModel& base, const Trial& trial, bool fit_soil = false);

}  // namespace talus::terramech
