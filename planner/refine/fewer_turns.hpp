#pragma once

#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// The cheapest route through some of the points in order, first and last kept, legs and turns priced: dynamic programming over pairs
/// of points up to 8 apart; turns that the route did not have pass allowed headings only. Of routes that cost the same the one of fewer points. Never dearer than the given one; that
/// itself where nothing is allowed. Ours.
Polyline withFewerTurns(const MotionCost& cost, const Polyline& route);

}  // namespace talus::planner
