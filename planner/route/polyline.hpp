#pragma once

#include <utility>
#include <vector>

#include <talus/maps/maps.hpp>

namespace talus::planner {

/// Polyline: points in map coordinates [m], connected by straight legs.
using Polyline = std::vector<maps::Point>;

/// Returns the polyline with each leg divided into equal parts of at most `longest_m` > 0.
Polyline subdivided(const Polyline& points, double longest_m);

/// Returns the length of the polyline [m].
double length_m(const Polyline& points) noexcept;

/// Cuts the polyline where its remaining length to the end is offset_m, offset_m + piece_m, offset_m + 2
/// piece_m, ... Because lengths are measured from the end, changes near the start do not move later cuts. The
/// pieces are in order from start to end; each piece begins at the end of the previous piece. A first piece
/// shorter than piece_m / 2 is joined to the second piece. Returns at least one piece. piece_m > 0; 0 <
/// offset_m <= piece_m.
std::vector<Polyline> cutFromEnd(const Polyline& points, double piece_m, double offset_m);

/// Cuts the polyline at marks. A mark is a point of the polyline with the smallest hash value of all its
/// points within the distance apart_m along the path. Marks depend on the nearby points only; therefore
/// changes elsewhere on the polyline move no cut. Cuts are more than apart_m apart; for dense points the mean
/// distance is twice as long.
std::vector<Polyline> cutAtMarks(const Polyline& points, double apart_m);

/// Splits the polyline at the point from which the length to the end is left_m, 0 < left_m < length.
std::pair<Polyline, Polyline> splitAt(const Polyline& points, double left_m);

/// Returns the polyline up to the first point within the distance `tolerance_m` >= 0 of the goal, or the
/// complete polyline if there is no such point.
Polyline cutWithin(Polyline points, maps::Point goal, double tolerance_m);

/// Appends `piece`, which must begin at the end of `points`.
void append(Polyline& points, const Polyline& piece);

}  // namespace talus::planner
