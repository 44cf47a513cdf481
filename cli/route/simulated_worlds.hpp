#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/planner/simulation/drive/simulation_site.hpp>

namespace talus::cli {

class Campaign;

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

/// Function that simulates world i under belief b.
using World = std::function<planner::WorldResult(std::size_t b, std::size_t i)>;

/// Number of beliefs and worlds, and of concurrent simulations without MPI.
struct WorldCount {
  std::size_t beliefs = 1;
  std::size_t worlds = 1;
  std::size_t workers = 1;
};

/// Simulates all worlds under all beliefs, distributed over the ranks of the campaign; results do not depend
/// on the number of ranks. An exception fails only its world. Returns an empty result on ranks other than 0.
SimulatedWorlds simulatedWorlds(const WorldCount& count, const World& world, const Campaign& campaign,
                                const ProgressMonitor& watch);

}  // namespace talus::cli
