#pragma once

#include <array>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <talus/planner/simulation/drive/simulation_rates.hpp>

namespace talus::cli {

/// Returns the display name of a belief (knowledge of the soils that the rover has at the start): the name of
/// planner::SoilKnowledge, or "perfect knowledge".
std::string label(planner::SoilKnowledge belief);

/// Returns the display name of an outcome: the name of planner::Outcome, or "no feasible route".
std::string label(planner::Outcome outcome);

/// Returns one traverse simulation as JSON: outcome, cause (empty if the rover reached the goal), energy_J,
/// length_m, time_s, replans, alarms, max_slip, categories_changed.
nlohmann::ordered_json asJson(const planner::WorldResult& result);

/// Returns the simulation result that asJson() wrote, without track, events and records; numbers are exact.
planner::WorldResult worldResult(const nlohmann::ordered_json& json);

/// Returns the simulations under one belief as JSON: rate of each outcome with 95 % interval, mean energy,
/// and each world (draw of the true soils).
nlohmann::ordered_json asJson(const std::vector<planner::WorldResult>& results);

/// Results of the worlds under each belief, in the order of planner::kBeliefs.
using BeliefResults = std::array<std::vector<planner::WorldResult>, planner::kBeliefs.size()>;

/// Returns the simulations under all beliefs in the same worlds as JSON, compared with perfect knowledge.
nlohmann::ordered_json asJson(const BeliefResults& beliefs);

/// Returns the content of the corresponding asJson() as text: lines or a table.
std::string asText(const planner::WorldResult& result);
std::string asText(const std::vector<planner::WorldResult>& results);
std::string asText(const BeliefResults& beliefs);

}  // namespace talus::cli
