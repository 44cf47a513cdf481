#pragma once

#include <cstdint>
#include <vector>

#include <talus/planner/bench/benchmark.hpp>

namespace talus::planner {

/// Questions on even ground with walls, each with its optimum: the shortest way round the walls' corners,
/// found over all pairs of corners that see each other and so by none of the planners. Joules are metres. A
/// route may come as near as it likes to the optimum but not reach it where a corner is to be rounded, since
/// corners may not be touched. Blocks of random size, then rooms joined by doors. Throws
/// std::invalid_argument unless side >= 16 and pairs > 0.
std::vector<BenchmarkCase> gridCases(int side, int pairs, std::uint64_t seed);

/// Length of the shortest way between the middles of two open cells of a map of blocked and open cells [m];
/// infinite where there is none.
double shortestAroundWalls_m(const costmap::CostGrid& map, maps::Cell from, maps::Cell to);

}  // namespace talus::planner
