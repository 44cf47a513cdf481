#pragma once

#include <optional>
#include <vector>

#include <talus/planner/reach/cell_side.hpp>
#include <talus/planner/route/heading_set.hpp>

namespace talus::planner {

/// A place on the border of a cell where a drive comes in or leaves on a heading; a place within it where it begins or
/// ends, without one.
struct CellGate {
  InCell place{};
  std::optional<double>
      heading_rad{};  ///< of the crossing, inwards for one that comes in, outwards for one that leaves
};

/// A drive through a cell by headings of a set, its turns at least 3e-6 of a side inside: straight where it may be, else the two
/// allowed headings on both sides of where it has to go, in turns. Both gates are crossed on straight legs, as long as
/// possible. The places after the first gate's up to the last one before the second gate's (a place within the cell is one of
/// them); empty where it takes more than some thousand turns or there is none.
std::vector<InCell> drivenThrough(const HeadingSet& headings, const CellGate& in, const CellGate& out);

}  // namespace talus::planner
