#pragma once

#include <functional>

#include <talus/planner/route/problem.hpp>
#include <talus/planner/sampling/sampling_settings.hpp>

namespace talus::planner {

/// Runs one OMPL planner for a problem without via points. Start and goal of the problem must lie in cells
/// that allow some heading. `known` is the plan with the known route from which the planner may start. The
/// status of the result is Found only if every motion and turn of the route is allowed.
Plan runOmpl(const Problem& leg, const SamplingSettings& settings, const Plan& known);

/// Function that returns an initial route for a problem without via points. A status other than Found means
/// that no initial route is known.
using InitialPathProvider = std::function<Plan(const Problem& leg)>;

/// Plans with the sampling planners of OMPL under the exact cost, leg by leg through the via points. `scout`
/// gives the initial route of each leg; if `scout` is empty, the planners start without a route. The result
/// is never more expensive than the initial route, and contains only allowed motions. Without a time limit,
/// equal problems and seeds give identical results; with a time limit, the result depends on the machine.
/// Throws std::invalid_argument for an unknown planner or a setting out of range.
Plan planBySampling(const Problem& problem, const SamplingSettings& settings,
                    const InitialPathProvider& scout = {});

}  // namespace talus::planner
