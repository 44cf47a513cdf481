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

/// In sides of a cell: how far within what is allowed a drive that is laid keeps.
struct ChainMargins {
  double slack = -1e-6;  ///< of cones
  double apart = 1e-5;   ///< of gates from corners
};

/// A cell that a drive passes, the side it comes in by (-1: it begins there), and the headings it may use there.
struct ChainLink {
  maps::Cell cell;
  int side = -1;
  HeadingSet headings{};
  bool everywhere = false;  ///< whether its turns may add up to every direction
};

/// A drive along a chain of cells.
struct LaidChain {
  Polyline points{};       ///< empty where there is none
  std::size_t failed = 0;  ///< then the first link that could not be driven
};

/// A drive through cells each of which has a side in common with the next, from a place of the first to one of the last, or to
/// the place of the last that is nearest to it, within a tolerance; exact by MotionCost.
///
/// How (ours). The parts of the sides that headings well within all cones reach are worked out from the start on, a funnel; the
/// deeper within the cones, the more room is left to cross sides on headings of both their cells. From the goal backwards a
/// place is chosen on each side from which the next is reached, in the middle of those.
LaidChain laidChain(const MotionCost& cost, const std::vector<ChainLink>& chain, const Segment& places,
                    double tolerance_m, const ChainMargins& margins = {});

/// The place of a cell nearest to one of the map that is reached from the segment between two of its places, if it lies
/// within the tolerance; the place itself where the tolerance is 0.
std::optional<InCell> nearestReached(const maps::Grid& grid, maps::Cell cell, const DriveCone& cone,
                                     const std::pair<InCell, InCell>& from, const Segment& places,
                                     double tolerance_m, double slack);

}  // namespace talus::planner
