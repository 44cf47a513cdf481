#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <talus/planner/reach/cell_side.hpp>
#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Distance in sides of a cell by which a constructed drive stays inside the permitted limits.
struct ChainMargins {
  double slack = -1e-6;  ///< margin of cones; negative values narrow them
  double apart = 1e-5;   ///< distance of crossings from corners
};

/// A cell on the drive, its entry side (-1: the drive begins there), and the headings permitted in the cell.
struct ChainLink {
  maps::Cell cell;
  int side = -1;
  HeadingSet headings{};
  bool everywhere = false;  ///< true if alternating headings can produce every direction
};

/// Drive along a chain of cells.
struct LaidChain {
  Polyline points{};       ///< empty if none was found
  std::size_t failed = 0;  ///< in this case: the first link that could not be driven
};

/// Constructs a drive through cells of which each shares a side with the next cell. The drive leads from a
/// place in the first cell to a place in the last cell, or to the nearest reachable place in the last cell
/// within a tolerance. The drive is valid under MotionCost.
///
/// Method (ours). A forward pass computes the range of each side that is reachable with headings inside all
/// cones. Narrower cones leave more freedom to cross a side with a heading permitted in both cells. A
/// backward pass from the goal chooses on each side a point from which the next point is reachable, in the
/// middle of the admissible range.
LaidChain laidChain(const MotionCost& cost, const std::vector<ChainLink>& chain, const Segment& places,
                    double tolerance_m, const ChainMargins& margins = {});

/// Returns the place of the cell nearest to `places.to` that is reachable, with headings of `cone`, from the
/// segment between the two places `from`. Returns nothing if the place is farther than `tolerance_m` from
/// `places.to`; with tolerance 0, only `places.to` itself is accepted. `slack` [cell sides] widens the cone;
/// a negative value narrows the cone.
std::optional<InCell> nearestReached(const maps::Grid& grid, maps::Cell cell, const HeadingCone& cone,
                                     const std::pair<InCell, InCell>& from, const Segment& places,
                                     double tolerance_m, double slack);

}  // namespace talus::planner
