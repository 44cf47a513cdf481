#pragma once

#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

struct PosePath;

/// A place on a route that violates a constraint.
struct Violation {
  maps::Point place;   ///< map coordinates [m]
  std::string reason;  ///< for example "required drawbar pull above the available drawbar pull"

  friend bool operator==(const Violation&, const Violation&) = default;
};

/// Checks every cell that the polyline crosses, touches at a corner or turns on, against every constraint of
/// the map for its heading: category, slope along and across, hazards, unknown ground, the map's edge. An end
/// of the route belongs to the cell given by Grid::cellAt(); other cells touched by an end need not be
/// allowed, because the rover does not turn there. Consecutive violations of a cell for the same reason are
/// returned once; empty for a drivable route. The check shares no code with the planners or MotionCost: it
/// sorts the crossings of cell sides and checks the centre of each section. Exact, not sampled. When stopped,
/// returns the violations found so far.
std::vector<Violation> violations(const costmap::CostGrid& map, const std::vector<maps::Point>& route,
                                  const ProgressMonitor& watch = {});

/// violations() of the chords of a drive, without checking the turns between chords: the drive's own turns
/// are checked separately, and the drive may reverse between two chords.
std::vector<Violation> violationsOfChords(const costmap::CostGrid& map,
                                          const std::vector<maps::Point>& chords);

/// Violations of a drive along its arcs. Crossings of cell sides are computed in closed form, and every cell
/// is checked for headings at most 0.01 rad apart, including those passed in a turn in place. Arcs of less
/// than the minimum turning radius, and turns in place if the radius is > 0, are also reported.
std::vector<Violation> violations(const costmap::CostGrid& map, const PosePath& drive,
                                  double turning_radius_m);

/// A place on a route that is not safe enough. dangers() returns these places in order along the route.
struct Danger {
  maps::Point place;         ///< map coordinates [m]
  double along_m = 0.0;      ///< distance along the polyline to the place
  double probability = 1.0;  ///< probability that the rover cannot drive: 1 for a constraint of the map
  std::string reason;        ///< as in Violation, or "the soil may give less drawbar pull than required"
};

/// Run-time monitor for an arbitrary path: violations(), plus every cell whose soil gives less drawbar pull
/// than required with a probability above `quantile`, 0 < quantile < 1. The probability is that of the cost
/// (TravelState::weak), for the ground that any wheel may stand on. Cells without a table of drive states
/// (tests) are checked by violations() only. Empty for a drivable route. Throws std::invalid_argument if the
/// quantile is out of range or a point is not finite.
std::vector<Danger> dangers(const costmap::CostGrid& map, const std::vector<maps::Point>& route,
                            double quantile = 0.05);

}  // namespace talus::planner
