#pragma once

#include <cstdint>
#include <vector>

#include <talus/maps/grid/grid.hpp>
#include <talus/planner/simulation/drive/traverse_simulation.hpp>
#include <talus/planner/simulation/worlds/true_world.hpp>

namespace talus::cli {

/// A cell whose displayed category changed during a drive.
struct CellChange {
  double time_s = 0.0;
  maps::Cell cell;
  std::uint8_t category = 0;  ///< terramech::Category as a number
};

/// Record of a simulated drive for an HTML page: events, changes of the map, and the true soil patches, which
/// the rover does not know.
struct TraverseRecord {
  planner::TraverseSimulation drive;
  std::vector<CellChange> changes;
  std::vector<planner::SoilPatch> patches;
  maps::Grid grid;  ///< grid of the cells of `changes`
};

}  // namespace talus::cli
