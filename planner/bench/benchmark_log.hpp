#pragma once

#include <string>
#include <vector>

#include <talus/planner/bench/benchmark.hpp>

namespace talus::planner {

/// The runs of one case as OMPL's benchmark log (text), which ompl_benchmark_statistics.py and Planner Arena
/// read: per run time, memory, status, correctness, cost, length, turns, gap to the best known, and cost over
/// time as progress.
std::string benchmarkLog(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs,
                         std::size_t case_index);

}  // namespace talus::planner
