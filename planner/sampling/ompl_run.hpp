#pragma once

#include <talus/planner/route/problem.hpp>
#include <talus/planner/sampling/sampling_settings.hpp>

namespace talus::planner {

/// Runs one OMPL planner for a problem without via points. Start and goal of the problem must lie in cells
/// that allow some heading. `known` is the plan with the known route from which the planner may start. The
/// status of the result is Found only if every motion and turn of the route is allowed.
Plan runOmpl(const Problem& leg, const SamplingSettings& settings, const Plan& known);

}  // namespace talus::planner
