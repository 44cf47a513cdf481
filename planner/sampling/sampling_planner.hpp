#pragma once

#include <functional>

#include <talus/planner/route/problem.hpp>
#include <talus/planner/sampling/sampling_settings.hpp>

namespace talus::planner {

/// Finds a route to improve on for a problem without via points; not Found: none is known.
using InitialPathProvider = std::function<Plan(const Problem& leg)>;

/// Plans with OMPL's sampling planners under the exact cost, leg by leg through the via points; never returns
/// a worse route than the scout knew, nor one that is not allowed along its whole length. The same bytes for
/// the same problem and seed where there is no time limit; with one, what the machine finds in that time. An
/// empty scout: the planners start from nothing. Throws std::invalid_argument for a planner that is not on
/// offer or a setting out of range.
Plan planBySampling(const Problem& problem, const SamplingSettings& settings,
                    const InitialPathProvider& scout = {});

}  // namespace talus::planner
