#pragma once

#include <cstdint>
#include <vector>

#include <talus/maps/grid/grid.hpp>
#include <talus/planner/simulation/drive/traverse_simulation.hpp>
#include <talus/planner/simulation/worlds/true_world.hpp>

namespace talus::cli {

/// A cell whose category for people changed during a drive.
struct CellChange {
  double time_s = 0.0;
  maps::Cell cell;
  std::uint8_t category = 0;  ///< terramech::Category as a number
};

/// a simulated drive as a page shows it: what happened when, what changed in the map, and what the rover
/// could not know.
struct DriveStory {
  planner::TraverseSimulation drive;
  std::vector<CellChange> changes;
  std::vector<planner::SoilPatch> patches;
  maps::Grid grid;  ///< of the cells of `changes`
};

}  // namespace talus::cli
