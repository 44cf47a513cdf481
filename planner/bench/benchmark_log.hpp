#pragma once

#include <string>
#include <vector>

#include <talus/planner/bench/benchmark.hpp>

namespace talus::planner {

/// Returns the runs of one case in the form of an OMPL benchmark log (text) for ompl_benchmark_statistics.py
/// and Planner Arena. The properties of a run are time, memory, status, correctness, cost, length, turns, gap
/// to the best known cost, cusps, turns in place, curvature and clearance. The progress of a run is its cost
/// over time.
std::string benchmarkLog(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs,
                         std::size_t case_index);

}  // namespace talus::planner
