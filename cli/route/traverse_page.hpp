#pragma once

#include <filesystem>

#include <talus/cli/draw/scene.hpp>
#include <talus/common/progress_monitor.hpp>
#include <talus/planner/route/route_json.hpp>
#include <talus/planner/simulation/drive/simulation_site.hpp>
#include <talus/planner/simulation/drive/traverse_log.hpp>

namespace talus::cli {

/// Traverse simulation of world 0 of a site, with the same result as site.world() and, in addition, wheel
/// records and the times of map changes.
struct RecordedTraverse {
  planner::WorldResult result;
  TraverseRecord story;
  planner::PredictionErrors prediction{};  ///< errors of the map's prediction at each step of the drive
};
/// Simulates world 0 of a site with the knowledge `belief` of the soils, and returns the record.
RecordedTraverse recordedTraverse(const planner::SimulationSite& site, planner::SoilKnowledge belief,
                                  const ProgressMonitor& watch);

/// Writes an HTML page with a time slider for the drive: track, current plan, cells with a changed category,
/// events and provenance. @throws InputError if the file cannot be written
void saveTraversePage(const std::filesystem::path& path, const planner::SimulationSite& site,
                      planner::SoilKnowledge belief, const RecordedTraverse& drive,
                      const planner::RouteOrigin& origin);

}  // namespace talus::cli
