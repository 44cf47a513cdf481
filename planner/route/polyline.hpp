#pragma once

#include <utility>
#include <vector>

#include <talus/maps/grid/grid.hpp>

namespace talus::planner {

/// Points from the first to the last, joined by straight legs.
using Polyline = std::vector<maps::Point>;

/// The same polyline with every leg cut into equal parts of at most longest_m metres, > 0.
Polyline subdivided(const Polyline& points, double longest_m);

/// Metres from the first point to the last.
double length_m(const Polyline& points) noexcept;

/// The polyline cut wherever the way left to its end is offset_m, offset_m + piece_m, offset_m + 2 piece_m...
/// Counted from the end, so that what changes near the start moves no cut behind it. In order from start to
/// end; each piece begins where the one before ends; a first piece shorter than half of piece_m stays joined
/// to the second. At least one piece. piece_m > 0; 0 < offset_m <= piece_m.
std::vector<Polyline> cutFromEnd(const Polyline& points, double piece_m, double offset_m);

/// The polyline cut at some of its points, which those near each of them choose among themselves, so that
/// what changes elsewhere moves no cut: whichever has the least hash of all within apart_m along the way.
/// Cuts lie more than apart_m apart, twice as far on average where points are dense.
std::vector<Polyline> cutAtMarks(const Polyline& points, double apart_m);

/// The part before and the part behind the place from where left_m are left to the end, 0 < left_m < length.
std::pair<Polyline, Polyline> splitAt(const Polyline& points, double left_m);

/// The polyline as far as the first place that is no farther from its goal than the tolerance, >= 0; whole
/// where it comes no nearer.
Polyline cutWithin(Polyline points, maps::Point goal, double tolerance_m);

/// Puts a piece behind a polyline that ends where it begins.
void append(Polyline& points, const Polyline& piece);

}  // namespace talus::planner
