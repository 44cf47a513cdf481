#pragma once

#include <functional>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Plans a route with `planner` such that `chassis` permits every pose of the route. After each plan, cells
/// are closed, that is, excluded for all headings: the cell of each violation, and the cells connected to it
/// at whose centres the chassis is not permitted on the same heading. Planning is then repeated, at most
/// `most_rounds` times. A route through a closed cell on another heading may therefore be missed. Returns
/// NoneFound with the reason if no route is left, and StartInvalid if the rover may not stand at the start.
Plan planOnChassis(const Problem& problem, const Chassis& chassis,
                   const std::function<Plan(const Problem&)>& planner, int most_rounds = 100);

}  // namespace talus::planner
