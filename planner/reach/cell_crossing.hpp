#pragma once

#include <optional>
#include <vector>

#include <talus/planner/reach/cell_side.hpp>
#include <talus/planner/route/heading_set.hpp>

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

}  // namespace talus::planner
