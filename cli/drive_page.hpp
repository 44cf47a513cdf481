#pragma once

#include <filesystem>

#include <planner/rehearsal_site.hpp>

namespace talus::cli {

/// Rehearses world 0 of a site and writes a page on which a slider runs through the drive: track, plan in
/// force, cells that changed their category, what happened. Returns the same result as site.world().
/// @throws InputError when the file cannot be written
planner::WorldResult saveDrivePage(const std::filesystem::path& path, const planner::RehearsalSite& site,
                                   planner::Belief belief, const Watch& watch);

}  // namespace talus::cli
