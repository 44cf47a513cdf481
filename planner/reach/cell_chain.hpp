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

/// Gate of a cell: a point on its border where a drive enters or leaves the cell, with the heading of the
/// crossing; or the start or the end of a drive inside the cell, without a heading.
struct CellGate {
  InCell place{};
  /// Heading into the cell at the entry, out of the cell at the exit; empty inside the cell.
  std::optional<double> heading_rad{};
};

/// Constructs a drive through a cell with headings of the set `headings`, from gate `in` to gate `out`. Turns
/// are at least 3e-6 of the cell side length away from the border. The drive is straight if that is
/// permitted; otherwise it alternates between the two permitted headings on both sides of the required
/// direction. Both gates are crossed on straight legs, as long as possible. Returns the vertices from the
/// first vertex after the entry to the last vertex before the exit (including gates inside the cell). The
/// result is empty if more than kMostLegs legs were needed or no drive exists.
std::vector<InCell> drivenThrough(const HeadingSet& headings, const CellGate& in, const CellGate& out);

/// Margins of a constructed drive, in units of the cell side length.
struct ChainMargins {
  double slack = -1e-6;  ///< margin by which cones of directions are widened; negative values narrow them
  double apart = 1e-5;   ///< smallest distance of crossings of cell sides from cell corners
};

/// Link of a chain of cells: a cell, the side through which the drive enters the cell (-1: the drive starts
/// in the cell), and the headings permitted in the cell.
struct ChainLink {
  maps::Cell cell;
  int side = -1;
  HeadingSet headings{};
  /// True if the drive can move in every direction by alternating between permitted headings.
  bool everywhere = false;
};

/// Result of laidChain(): a drive along a chain of cells.
struct LaidChain {
  Polyline points{};       ///< vertices of the drive; empty if no drive was found
  std::size_t failed = 0;  ///< if no drive was found: index of the first link that could not be crossed
};

/// Constructs a drive along a chain of cells, each of which shares a side with the next cell. The drive leads
/// from `places.from` in the first cell to `places.to` in the last cell, or to the nearest reachable point of
/// the last cell within `tolerance_m` of `places.to`. The drive is allowed by MotionCost.
///
/// Method (ours). A forward pass computes the range of each side that is reachable with directions inside the
/// cones of all cells (HeadingCone). Narrower cones leave more freedom to cross a side with a heading
/// permitted in both cells. A backward pass from the goal selects on each side a point from which the next
/// point is reachable, in the middle of the admissible range.
LaidChain laidChain(const MotionCost& cost, const std::vector<ChainLink>& chain, const Segment& places,
                    double tolerance_m, const ChainMargins& margins = {});

/// Returns the point of `cell` nearest to `places.to` that is reachable, with directions in `cone`, from the
/// segment between the two points `from`. Returns nullopt if this point is farther than `tolerance_m` from
/// `places.to`; with tolerance 0, only `places.to` itself is accepted. `slack` [cell sides] widens the cone;
/// a negative value narrows the cone.
std::optional<InCell> nearestReached(const maps::Grid& grid, maps::Cell cell, const HeadingCone& cone,
                                     const std::pair<InCell, InCell>& from, const Segment& places,
                                     double tolerance_m, double slack);

}  // namespace talus::planner
