#pragma once

#include <cstdint>
#include <vector>

#include <talus/planner/bench/benchmark.hpp>

namespace talus::planner {

/// Cases on uniform ground with walls, each with its optimum: the shortest path around the walls' corners,
/// computed over all pairs of mutually visible corners, independently of the planners. Costs in joules equal
/// lengths in metres. A route may approach the optimum but not reach it if the path turns at a corner,
/// because corners may not be touched. First blocks of random size, then rooms connected by doors; up to
/// `pairs` cases of each. Throws std::invalid_argument unless side >= 16 and pairs > 0.
std::vector<BenchmarkCase> gridCases(int side, int pairs, std::uint64_t seed);

/// Returns the length [m] of the shortest path between the centres of two open cells of a map of blocked and
/// open cells; infinite if there is none.
double shortestAroundWalls_m(const costmap::CostGrid& map, maps::Cell from, maps::Cell to);

}  // namespace talus::planner
