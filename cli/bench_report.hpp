#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <planner/benchmark.hpp>

namespace talus::cli {

/// One line of the comparison: a planner over all cases and seeds.
struct BenchmarkLine {
  std::string planner;
  int runs = 0;
  int found = 0;
  int breached = 0;  ///< routes that the independent check refuses
  int crashed = 0;
  double median_gap = 0.0;  ///< to the best known [-]; NaN when nothing was found
  double worst_gap = 0.0;
  double median_seconds = 0.0;
  double worst_megabytes = 0.0;
  double mean_cusps = 0.0;             ///< of drives
  double max_curvature_1_m = 0.0;      ///< of drives
  double least_clearance_cells = 0.0;  ///< to a cell that no heading may enter; NaN when nothing was found
};

std::vector<BenchmarkLine> compared(const planner::BenchmarkPlan& plan,
                                    const std::vector<planner::BenchmarkRun>& runs);

/// The comparison as columns for a terminal, as JSON, and as a page with the cost over time of every case.
std::string asText(const std::vector<BenchmarkLine>& lines);
nlohmann::ordered_json asJson(const std::vector<BenchmarkLine>& lines);
std::string asPage(const planner::BenchmarkPlan& plan, const std::vector<planner::BenchmarkRun>& runs);

}  // namespace talus::cli
