#pragma once

#include <array>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <talus/planner/simulation/drive/simulation_rates.hpp>

namespace talus::cli {

/// The belief as people read it: the name of planner::Belief, or "perfect knowledge".
std::string label(planner::Belief belief);

/// The outcome as people read it: the name of planner::Outcome, or "no feasible route".
std::string label(planner::Outcome outcome);

/// One traverse simulation: outcome, cause (empty where it reached the goal), energy_J, length_m, time_s,
/// replans, alarms, max_slip, categories_changed.
nlohmann::ordered_json asJson(const planner::WorldResult& result);

/// The inverse of asJson() of a world, without track, events and records; numbers are exact.
planner::WorldResult worldResult(const nlohmann::ordered_json& json);

/// Many under one belief: the rate of each outcome with its 95 % interval, mean energy, and each world.
nlohmann::ordered_json asJson(const std::vector<planner::WorldResult>& results);

/// Worlds under each belief, in the order of planner::kBeliefs.
using BeliefResults = std::array<std::vector<planner::WorldResult>, planner::kBeliefs.size()>;

/// All beliefs in the same worlds, compared with perfect knowledge.
nlohmann::ordered_json asJson(const BeliefResults& beliefs);

/// The same as text: lines or a table.
std::string asText(const planner::WorldResult& result);
std::string asText(const std::vector<planner::WorldResult>& results);
std::string asText(const BeliefResults& beliefs);

}  // namespace talus::cli
