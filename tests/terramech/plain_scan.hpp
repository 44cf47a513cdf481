#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration.hpp>

namespace talus::terramech {

/// A simple analysis for comparison with tracing: fits the soil, then fits each column to the residual of
/// each channel by a line, a spline of four knots and a mean of each level, with cross-validation over whole
/// runs. The column with the largest relative reduction of the squared error is accepted if the reduction
/// exceeds 5 % and three standard errors over the runs. The fit is subtracted, and the scan is repeated.
/// Returns at most three columns.
std::vector<std::string> plainScan(const RefinedModel& base, const Trial& trial, bool fit_soil = false);

}  // namespace talus::terramech
