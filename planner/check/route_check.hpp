#pragma once

#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

struct PosePath;

/// A place on a route that a constraint forbids.
struct Violation {
  maps::Point place;
  std::string reason;  ///< "required drawbar pull above the available drawbar pull"

  friend bool operator==(const Violation&, const Violation&) = default;
};

/// Every cell that the polyline drives, touches at a corner or turns on, held against every constraint that
/// the map knows for its heading: category, tilt along and across, hazards, unknown ground, the map's edge.
/// A route ends in the cell that Grid::cellAt gives it and need not be allowed in others that its ends touch:
/// it does not turn there. One violation a cell; empty for a route that may be driven. It shares no code with the planners, nor with
/// MotionCost: the crossings of cell edges are sorted and the middle of each stretch is looked up. Exact, not
/// sampled. Stopped, those met so far.
std::vector<Violation> violations(const costmap::CostGrid& map, const std::vector<maps::Point>& route,
                                  const ProgressMonitor& watch = {});

/// The same of the chords of a drive, which may reverse between two of them: turns are those of the drive.
std::vector<Violation> violationsOfChords(const costmap::CostGrid& map,
                                          const std::vector<maps::Point>& chords);

/// The same of a drive, along its arcs themselves: where each crosses the lines between cells is found in
/// closed form, and every cell is checked for headings no more than 0.01 rad apart, those passed in a turn in
/// place included. Also reported: an arc that bends more than the radius allows.
std::vector<Violation> violations(const costmap::CostGrid& map, const PosePath& drive,
                                  double turning_radius_m);

/// A place on a route that is not safe enough, met in this order.
struct Danger {
  maps::Point place;
  double along_m = 0.0;      ///< way along the polyline to the place
  double probability = 1.0;  ///< that the rover cannot drive there: 1 for a constraint that the map knows
  std::string reason;        ///< of Violation, or "the soil may give less drawbar pull than required"
};

/// A run-time monitor for anybody's path: violations(), and every cell whose soil gives less pull than the slope asks
/// with more than this probability, 0 < quantile < 1; that is, where the quantile of the believed pull falls short.
/// The probability is that behind the cost (DriveState::weak), of the ground that any wheel may stand on. Cells whose table is not known (tests) are judged by
/// violations() alone. Empty for a route that may be driven. Throws std::invalid_argument for a quantile out of range.
std::vector<Danger> dangers(const costmap::CostGrid& map, const std::vector<maps::Point>& route,
                            double quantile = 0.05);

}  // namespace talus::planner
