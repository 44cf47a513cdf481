#pragma once

#include <string>
#include <vector>

#include <talus/terramech/calibration/table/trial.hpp>

namespace talus::terramech {

/// A simple analysis for comparison with tracing: fits the soil, then tries each column on the residual of
/// each channel as a line, a spline of four knots and a mean of each level, by cross-validation over whole
/// runs. The column with the largest relative reduction of the squared error is accepted if the reduction
/// exceeds 5 % and three standard errors over the runs; its fit is subtracted and the scan repeated. Returns
/// the columns, at most three.
std::vector<std::string> plainScan(const RefinedModel& base, const Trial& trial, bool fit_soil = false);

}  // namespace talus::terramech
