#pragma once

#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

struct PosePath;

/// Point on a route that violates a constraint.
struct Violation {
  maps::Point place;   ///< map coordinates [m]
  std::string reason;  ///< for example "required drawbar pull above the available drawbar pull"

  friend bool operator==(const Violation&, const Violation&) = default;
};

/// Returns the violations of a polyline, empty for a drivable route. Every cell that the polyline crosses,
/// touches at a corner or turns on is checked against every constraint of the map for the heading of the leg:
/// category, slope along and across, hazards, unknown ground, edge of the map. Start and goal are checked
/// only in the cell given by Grid::cellAt(), because the rover does not turn on other cells that these points
/// touch. Consecutive violations in one cell for the same reason are returned once. The check shares no code
/// with the planners or MotionCost: it sorts the crossings of cell sides and checks the centre of each
/// section. The check is exact, not sampled. After a stop request by `watch`, returns the violations found
/// until then.
std::vector<Violation> violations(const costmap::CostGrid& map, const std::vector<maps::Point>& route,
                                  const ProgressMonitor& watch = {});

/// Returns the violations along the chords of a drive (route with arcs), without a check of the turns between
/// chords. The turns of the drive are checked separately, and the drive may reverse between two chords.
std::vector<Violation> violationsOfChords(const costmap::CostGrid& map,
                                          const std::vector<maps::Point>& chords);

/// Returns the violations of a drive along its arcs. Crossings of cell sides are computed in closed form, and
/// every cell is checked for headings at most 0.01 rad apart, including the headings passed in a turn in
/// place. Arcs with less than the minimum turning radius `turning_radius_m`, and turns in place if this
/// radius is > 0, are also violations.
std::vector<Violation> violations(const costmap::CostGrid& map, const PosePath& drive,
                                  double turning_radius_m);

/// Point on a route at which the rover violates a constraint or may lack drawbar pull. dangers() returns
/// these points in order along the route.
struct Danger {
  maps::Point place;     ///< map coordinates [m]
  double along_m = 0.0;  ///< distance along the polyline from its start
  /// Probability that the rover cannot drive, (0, 1]; 1 for a violated constraint of the map.
  double probability = 1.0;
  std::string reason;  ///< reason of the violation, or "the soil may give less drawbar pull than required"
};

/// Run-time monitor for a path from any source. Returns violations(), and every cell whose soil provides less
/// drawbar pull than required with a probability above `quantile`, 0 < quantile < 1. The probability is
/// that of the cost function (TravelState::weak), for the weakest ground on which a wheel may stand. Cells
/// without a table of drive states (tests) are checked by violations() only. The result is empty for a
/// drivable route. Throws std::invalid_argument if the quantile is out of range or a point is not finite.
std::vector<Danger> dangers(const costmap::CostGrid& map, const std::vector<maps::Point>& route,
                            double quantile = 0.05);

}  // namespace talus::planner
