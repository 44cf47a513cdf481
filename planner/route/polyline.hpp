#pragma once

#include <utility>
#include <vector>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// Points joined by straight legs.
using Polyline = std::vector<maps::Point>;

/// The polyline with each leg divided into equal parts of at most longest_m > 0.
Polyline subdivided(const Polyline& points, double longest_m);

/// Returns the length of the polyline [m].
double length_m(const Polyline& points) noexcept;

/// Cuts the polyline at remaining lengths offset_m, offset_m + piece_m, offset_m + 2 piece_m, ... The lengths
/// are measured from the end, so that changes near the start do not move later cuts. Pieces are in order from
/// start to end; each begins at the end of the previous piece. A first piece shorter than piece_m / 2 is
/// joined to the second piece. Returns at least one piece. piece_m > 0; 0 < offset_m <= piece_m.
std::vector<Polyline> cutFromEnd(const Polyline& points, double piece_m, double offset_m);

/// Cuts the polyline at those of its points that have the least hash of all points within apart_m along the
/// path. The choice is local, so that changes elsewhere move no cut. Cuts are more than apart_m apart, twice
/// as far on average for dense points.
std::vector<Polyline> cutAtMarks(const Polyline& points, double apart_m);

/// Splits the polyline at the remaining length left_m, 0 < left_m < length.
std::pair<Polyline, Polyline> splitAt(const Polyline& points, double left_m);

/// The polyline up to the first place within the tolerance, >= 0, of the goal; complete if there is no such
/// place.
Polyline cutWithin(Polyline points, maps::Point goal, double tolerance_m);

/// Appends a piece that begins at the end of the polyline.
void append(Polyline& points, const Polyline& piece);

}  // namespace talus::planner
