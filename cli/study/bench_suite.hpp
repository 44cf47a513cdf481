#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <talus/cli/ground/ground_options.hpp>
#include <talus/planner/bench/benchmark.hpp>

namespace talus::cli {

struct Context;

/// Which cases are planned.
struct SuiteOptions {
  std::vector<std::string> names{"generated"};  ///< "generated", "slip", "grids", DEMs, MovingAI .scen files
  int pairs = 3;                                ///< starts and goals a map, > 0; worlds of "slip"
  int side_cells = 300;                         ///< of generated sites
  double turning_radius_m = -1.0;               ///< that planners of drives keep; < 0: the rover's
  GroundOptions ground;                         ///< for DEMs: layers, rover, soils, policy
};

/// The cases of all suites named. Throws InputError for a file that cannot be used.
std::vector<planner::BenchmarkCase> suiteCases(const SuiteOptions& options, const Context& context);

}  // namespace talus::cli
