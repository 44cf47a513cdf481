#pragma once

#include <filesystem>

#include <talus/cli/draw/drive_story.hpp>
#include <talus/common/progress_monitor.hpp>
#include <talus/planner/route/route_json.hpp>
#include <talus/planner/simulation/drive/drive_log.hpp>
#include <talus/planner/simulation/drive/simulation_site.hpp>

namespace talus::cli {

/// World 0 of a site, watched: the same result as site.world(), with records of the wheels and what changed
/// when.
struct WatchedDrive {
  planner::WorldResult result;
  DriveStory story;
  planner::PredictionErrors prediction{};  ///< of the map's prediction of each step
};
WatchedDrive watchedDrive(const planner::SimulationSite& site, planner::Belief belief,
                          const ProgressMonitor& watch);

/// Writes a page on which a slider runs through the drive: track, plan in force, cells that changed their
/// category, what happened, and what the drive is made from. @throws InputError when the file cannot be written
void saveDrivePage(const std::filesystem::path& path, const planner::SimulationSite& site,
                   planner::Belief belief, const WatchedDrive& drive, const planner::RouteOrigin& origin);

}  // namespace talus::cli
