#pragma once

#include <functional>

#include <talus/planner/check/chassis.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Plans a route along which the chassis may stand everywhere. The cell of each violation and the connected
/// cells that refuse the same heading are closed, and planning is repeated, at most `most_rounds` times. A
/// cell is closed for all headings, so a route on another heading may be lost. Returns NoneFound with the
/// reason if no route is left, and StartInvalid if the rover may not stand at the start.
Plan planOnChassis(const Problem& problem, const Chassis& chassis,
                   const std::function<Plan(const Problem&)>& planner, int most_rounds = 100);

}  // namespace talus::planner
