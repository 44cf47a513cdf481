#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/planner/plan/risk_planner.hpp>

namespace talus::cli {

/// Draws the Pareto front of routes: energy over risk and energy over time, with one point per route. Writes
/// PNG, SVG or, for .html, a page with the numbers. @throws InputError if the file cannot be written
void saveParetoChart(const std::string& path, const std::vector<planner::ParetoRoute>& front);

/// Returns energy_J, time_s and risk of the routes, and the weights with which the routes were planned.
nlohmann::ordered_json paretoJson(const std::vector<planner::ParetoRoute>& front);

}  // namespace talus::cli
