#pragma once

#include <functional>

#include <talus/planner/route/problem.hpp>
#include <talus/planner/sampling/sampling_settings.hpp>

namespace talus::planner {

/// Provides an initial route for a problem without via points; a status other than Found means that none is
/// known.
using InitialPathProvider = std::function<Plan(const Problem& leg)>;

/// Plans with OMPL's sampling planners under the exact cost, leg by leg through the via points. Never returns
/// a costlier route than the initial route of `scout`, nor a route with a motion that is not allowed. Without
/// a time limit, equal problems and seeds give identical results; with a time limit, the result depends on
/// the machine. If `scout` is empty, planners start without a route. Throws std::invalid_argument for an
/// unknown planner or a setting out of range.
Plan planBySampling(const Problem& problem, const SamplingSettings& settings,
                    const InitialPathProvider& scout = {});

}  // namespace talus::planner
