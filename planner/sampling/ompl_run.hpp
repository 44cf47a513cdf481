#pragma once

#include <talus/planner/route/problem.hpp>
#include <talus/planner/sampling/sampling_settings.hpp>

namespace talus::planner {

/// One run of one of OMPL's planners over a problem without via points; its ends are known to be on allowed
/// ground. The plan is Found only when it is allowed along its whole length.
Plan runOmpl(const Problem& leg, const SamplingSettings& settings, const Plan& known);

}  // namespace talus::planner
