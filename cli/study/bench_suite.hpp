#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/cli/draw/plot.hpp>
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

/// Row of the comparison of planners: one planner over all cases and seeds.
struct BenchmarkLine {
  std::string planner;
  int runs = 0;
  int found = 0;
  int breached = 0;  ///< number of routes that the independent check rejects
  /// Number of runs whose process ended without an answer.
  int crashed = 0;
  /// Median gap of the cost to the best known cost, over valid routes [-]; NaN: no valid route.
  double median_gap = 0.0;
  double worst_gap = 0.0;
  double median_seconds = 0.0;
  double worst_megabytes = 0.0;
  /// Mean number of reversals (cusps) per path, for drives (paths with headings) only.
  double mean_cusps = 0.0;
  double max_curvature_1_m = 0.0;      ///< greatest curvature [1/m], for drives only
  double least_clearance_cells = 0.0;  ///< least distance to a cell that no heading may enter; NaN: no route
};

/// Returns one row per planner.
std::vector<BenchmarkLine> compared(const planner::BenchmarkPlan& plan,
                                    const std::vector<planner::BenchmarkRun>& runs);

/// Row of simulated drives over the true slip: one planner over all worlds (true soils) of a group.
struct WorldLine {
  std::string group;
  std::string planner;
  int runs = 0;
  int reached = 0;
  double median_drive_s = 0.0;   ///< median duration of the drives that reached the goal; NaN: no such drive
  double median_max_slip = 0.0;  ///< median of the greatest slip of each driven route [-]; NaN: no such route
};

/// Returns one row per group and planner; empty if no case has a world.
std::vector<WorldLine> drivesOf(const planner::BenchmarkPlan& plan,
                                const std::vector<planner::BenchmarkRun>& runs);

/// Returns plots of the gap over time for the first cases, with one curve per planner, of its first seed, if
/// its route passes the check.
std::vector<Plot> gapsOverTime(const planner::BenchmarkPlan& plan,
                               const std::vector<planner::BenchmarkRun>& runs);

/// Return the comparison as JSON, and as a report with 95 % intervals of the fraction of drives that reached the goal and
/// the cost over time of each case.
nlohmann::ordered_json asJson(const std::vector<BenchmarkLine>& lines, const std::vector<WorldLine>& drives);
Report benchReport(const planner::BenchmarkPlan& plan, const std::vector<planner::BenchmarkRun>& runs);

}  // namespace talus::cli
