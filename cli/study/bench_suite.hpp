#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <talus/cli/ground/ground_options.hpp>
#include <talus/planner/bench/benchmark.hpp>

namespace talus::cli {

struct Context;

/// Selection of the benchmark cases.
struct SuiteOptions {
  std::vector<std::string> names{"generated"};  ///< "generated", "slip", "grids", DEMs, MovingAI .scen files
  int pairs = 3;                                ///< start-goal pairs per map, > 0; number of "slip" worlds
  int side_cells = 300;                         ///< side length of generated sites
  double turning_radius_m = -1.0;               ///< for planners of drives; < 0: that of the rover
  GroundOptions ground;                         ///< for DEMs: layers, rover, soils, policy
};

/// Cases of all named suites. Throws InputError for an unusable file.
std::vector<planner::BenchmarkCase> suiteCases(const SuiteOptions& options, const Context& context);

}  // namespace talus::cli
