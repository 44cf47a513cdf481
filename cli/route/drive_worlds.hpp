#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/planner/simulation/drive/simulation_site.hpp>

namespace talus::cli {

class Campaign;

/// What random worlds came to under one belief, or several in the same worlds.
struct DrivenWorlds {
  /// A world that could not be simulated.
  struct Failure {
    std::size_t world = 0;
    std::string reason;
  };

  std::vector<std::vector<planner::WorldResult>> results;  ///< of each belief, the worlds that none failed in
  std::vector<Failure> failures;
};

/// World number i under belief number b.
using World = std::function<planner::WorldResult(std::size_t b, std::size_t i)>;

/// How many of each, and how many at a time in a plain run.
struct WorldCount {
  std::size_t beliefs = 1;
  std::size_t worlds = 1;
  std::size_t workers = 1;
};

/// Rehearses all worlds under all beliefs over the ranks of the campaign: the same results however many there
/// are. A world that throws is a failure of that world alone. Empty but on the leading rank.
DrivenWorlds drivenWorlds(const WorldCount& count, const World& world, const Campaign& campaign,
                          const ProgressMonitor& watch);

}  // namespace talus::cli
