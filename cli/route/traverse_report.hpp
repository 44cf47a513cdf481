#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <talus/cli/app/campaign.hpp>
#include <talus/cli/draw/scene.hpp>
#include <talus/common/common.hpp>
#include <talus/planner/route/route_json.hpp>
#include <talus/planner/simulation/simulation.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

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

/// Results of traverse simulations in random worlds under one or several beliefs. A world is one draw of the
/// true soils; a belief is the knowledge of the soils that the rover has at the start
/// (planner::SoilKnowledge).
struct SimulatedWorlds {
  /// A world whose simulation failed.
  struct Failure {
    std::size_t world = 0;
    std::string reason;
  };

  std::vector<std::vector<planner::WorldResult>> results;  ///< results by belief, without failed worlds
  std::vector<Failure> failures;
};

/// Returns the simulations of a campaign whose job b `worlds` + i is asJson() of world i under belief b; worlds without
/// a result are omitted.
SimulatedWorlds simulatedWorlds(std::size_t beliefs, std::size_t worlds, const JobResults& jobs);

/// Writes the wheel telemetry of a traverse simulation as CSV, which `talus update` can read. @throws
/// InputError if the file cannot be written
void saveTelemetry(const std::filesystem::path& path, const planner::TraverseSimulation& drive,
                   const terramech::Rover& rover);

/// Traverse simulation of world 0 of a site, with the same result as site.world() and, in addition, wheel
/// records and the times of map changes.
struct RecordedTraverse {
  planner::WorldResult result;
  TraverseRecord story;
  planner::TraverseLog log;  ///< prediction of the map and truth at each step of the drive
};
/// Simulates world 0 of a site with the knowledge `belief` of the soils, and returns the record.
RecordedTraverse recordedTraverse(const planner::SimulationSite& site, planner::SoilKnowledge belief,
                                  const ProgressMonitor& watch);

/// Returns the errors of the prediction, as "slip error 0.021 rms, total energy error +3.1 %".
std::string predictionText(const RecordedTraverse& drive);

/// Writes an HTML page with a time slider for the drive: track, current plan, cells with a changed category,
/// events and provenance, and profiles of what was predicted beside what was driven. @throws InputError if the file cannot be written
void saveTraversePage(const std::filesystem::path& path, const planner::SimulationSite& site,
                      planner::SoilKnowledge belief, const RecordedTraverse& drive,
                      const planner::RouteOrigin& origin);

}  // namespace talus::cli
