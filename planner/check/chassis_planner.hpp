#pragma once

#include <functional>

#include <talus/planner/check/chassis.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Plans until the chassis may stand everywhere along the route: where it may not, the cell and those around
/// it that refuse the same heading are closed and planning is repeated, `most_rounds` times at most. Closing
/// a cell to all headings may cost a way that another heading would have kept. NoneFound with the reason when
/// none is left; StartInvalid where the rover may not stand at the start.
Plan planOnChassis(const Problem& problem, const Chassis& chassis,
                   const std::function<Plan(const Problem&)>& planner, int most_rounds = 100);

}  // namespace talus::planner
