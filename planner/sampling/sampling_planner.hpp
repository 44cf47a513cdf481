#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Settings of the planners of OMPL. The default values performed best on maps of 1000 x 1000 cells.
struct SamplingSettings {
  std::string planner = "RRTstar";  ///< name of plannerNames() except "field"
  /// Limit of the total length of all evaluated motions [cell sides], > 0. It gives the same result on every
  /// machine and applies only to problems without a time limit.
  std::uint64_t work = 4'000'000;
  double range_cells = 40.0;  ///< length of the longest motion that is added to a tree [cells], > 0
  /// true: no initial route; false: the planner starts from the route of the field planner.
  bool cold = false;
  std::map<std::string, std::string> parameters{};  ///< parameters of the OMPL planner, in the units of OMPL
  std::function<void(double)> better{};  ///< called with the cost [J] of each improvement of the present leg
};

/// Parses a planner name of plannerNames() with optional settings, such as "NAME", "NAME:cold" or
/// "NAME:range=20:cold". Throws std::invalid_argument for an unknown name, for "cold" or a parameter of a
/// planner that is not of OMPL, for an unknown parameter and for an invalid value.
SamplingSettings samplingSettings(const std::string& words);

/// Returns all planner names, and the names of the OMPL planners followed by ":cold".
std::vector<std::string> warmAndCold();

/// Returns the text that samplingSettings() parses to these settings.
std::string wordsOf(const SamplingSettings& settings);

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
