#pragma once

#include <talus/planner/route/problem.hpp>
#include <talus/planner/sampling/sampling_settings.hpp>

namespace talus::planner {

/// Runs one OMPL planner for a problem without via points whose ends are known to be allowed. Found only if
/// the whole route is allowed.
Plan runOmpl(const Problem& leg, const SamplingSettings& settings, const Plan& known);

}  // namespace talus::planner
