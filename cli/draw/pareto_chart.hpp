#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/planner/plan/risk_planner.hpp>

namespace talus::cli {

/// Draws what may be traded: energy against risk and against time, a point a route. PNG, SVG or, for .html, a
/// page with the numbers. @throws InputError when the file cannot be written
void saveParetoChart(const std::string& path, const std::vector<planner::ParetoRoute>& front);

/// The routes' energy_J, time_s, risk and the prices that picked them.
nlohmann::ordered_json paretoJson(const std::vector<planner::ParetoRoute>& front);

}  // namespace talus::cli
