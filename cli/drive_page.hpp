#pragma once

#include <filesystem>

#include <cli/drive_story.hpp>
#include <planner/drive_log.hpp>
#include <planner/rehearsal_site.hpp>

namespace talus::cli {

/// World 0 of a site, watched: the same result as site.world(), with records of the wheels and what changed
/// when.
struct WatchedDrive {
  planner::WorldResult result;
  DriveStory story;
  planner::PredictionErrors prediction{};  ///< of what the map said of each step before it was driven
};
WatchedDrive watchedDrive(const planner::RehearsalSite& site, planner::Belief belief, const Watch& watch);

/// Writes a page on which a slider runs through the drive: track, plan in force, cells that changed their
/// category, what happened. @throws InputError when the file cannot be written
void saveDrivePage(const std::filesystem::path& path, const planner::RehearsalSite& site,
                   planner::Belief belief, const WatchedDrive& drive);

}  // namespace talus::cli
