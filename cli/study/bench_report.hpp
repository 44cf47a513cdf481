#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/cli/draw/plot.hpp>
#include <talus/planner/bench/benchmark.hpp>

namespace talus::cli {

/// A row of the comparison: one planner over all cases and seeds.
struct BenchmarkLine {
  std::string planner;
  int runs = 0;
  int found = 0;
  int breached = 0;  ///< routes that the independent check refuses
  int crashed = 0;
  double median_gap = 0.0;  ///< gap to the best known cost [-], over valid routes; NaN: none
  double worst_gap = 0.0;
  double median_seconds = 0.0;
  double worst_megabytes = 0.0;
  double mean_cusps = 0.0;             ///< drives only
  double max_curvature_1_m = 0.0;      ///< drives only
  double least_clearance_cells = 0.0;  ///< distance to a cell that no heading may enter; NaN: no route
};

std::vector<BenchmarkLine> compared(const planner::BenchmarkPlan& plan,
                                    const std::vector<planner::BenchmarkRun>& runs);

/// Simulated drives over the true slip: one planner over all worlds of a group.
struct WorldLine {
  std::string group;
  std::string planner;
  int runs = 0;
  int reached = 0;
  double median_drive_s = 0.0;   ///< of drives that reached the goal; NaN: none
  double median_max_slip = 0.0;  ///< of all driven routes [-]; NaN: none
};

/// Returns one line per group and planner; empty if no case has a world.
std::vector<WorldLine> drivesOf(const planner::BenchmarkPlan& plan,
                                const std::vector<planner::BenchmarkRun>& runs);

/// Table with 95 % intervals of the share that reached the goal; empty without lines.
std::string asText(const std::vector<WorldLine>& lines);

/// Gap over time for the first cases: one curve per planner, of its first seed, if its route passes the
/// check.
std::vector<Plot> gapsOverTime(const planner::BenchmarkPlan& plan,
                               const std::vector<planner::BenchmarkRun>& runs);

/// The comparison as a table for a terminal, as JSON, and as a page with the cost over time of each case.
std::string asText(const std::vector<BenchmarkLine>& lines);
nlohmann::ordered_json asJson(const std::vector<BenchmarkLine>& lines, const std::vector<WorldLine>& drives);
std::string asPage(const planner::BenchmarkPlan& plan, const std::vector<planner::BenchmarkRun>& runs);

}  // namespace talus::cli
