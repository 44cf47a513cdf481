#pragma once

#include <string>
#include <vector>

#include <talus/planner/bench/benchmark.hpp>

namespace talus::planner {

/// The runs of one case as an OMPL benchmark log (text) for ompl_benchmark_statistics.py and Planner Arena.
/// Properties of a run: time, memory, status, correctness, cost, length, turns, gap to the best known cost,
/// cusps, turns in place, curvature and clearance; progress: cost over time.
std::string benchmarkLog(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs,
                         std::size_t case_index);

}  // namespace talus::planner
