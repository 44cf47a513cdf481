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
  /// Names of suites: "generated", "slip", "grids", elevation maps (DEMs), or MovingAI .scen files.
  std::vector<std::string> names{"generated"};
  int pairs = 3;         ///< number of start-goal pairs per map, > 0; number of worlds for "slip"
  int side_cells = 300;  ///< side length of generated sites, in cells
  /// Turning radius for planners of drives (paths with headings); < 0: that of the rover.
  double turning_radius_m = -1.0;
  GroundOptions ground;  ///< layers, rover, soils and policy for DEMs
};

/// Returns the benchmark cases of all named suites. Throws InputError for an unusable file.
std::vector<planner::BenchmarkCase> suiteCases(const SuiteOptions& options, const Context& context);

}  // namespace talus::cli
