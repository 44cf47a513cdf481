#pragma once

#include <optional>
#include <vector>

#include <talus/planner/reach/cell_side.hpp>
#include <talus/planner/route/heading_set.hpp>

namespace talus::planner {

/// Entry or exit of a drive on the border of a cell, with the heading of the crossing; or the start or end of
/// a drive inside the cell, without heading.
struct CellGate {
  InCell place{};
  std::optional<double> heading_rad{};  ///< into the cell at the entry, out of the cell at the exit
};

/// Constructs a drive through a cell with headings of a set; turns are at least 3e-6 of a side away from the
/// border. The drive is straight if permitted; otherwise it alternates between the permitted headings on both
/// sides of the required direction. Both gates are crossed on straight legs, as long as possible. Returns the
/// places after the entry up to the last place before the exit (including gates inside the cell); empty if
/// more than kMostLegs legs were needed or no drive exists.
std::vector<InCell> drivenThrough(const HeadingSet& headings, const CellGate& in, const CellGate& out);

}  // namespace talus::planner
