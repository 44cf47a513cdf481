#pragma once

#include <cstdint>
#include <vector>

#include <talus/planner/bench/benchmark.hpp>

namespace talus::planner {

/// Returns cases on uniform ground with walls, each with its optimum. The optimum is the shortest path around
/// the corners of the walls, computed over all pairs of mutually visible corners, independently of the
/// planners. Costs in joules equal lengths in metres. If the optimal path turns at a corner, a route can
/// approach its length but not reach it, because the rover may not touch corners. `side` is the side length
/// of a map [cells]. The first cases have blocks of random size, the others have rooms connected by doors;
/// there are up to `pairs` cases of each kind. Throws std::invalid_argument unless side >= 16 and pairs > 0.
std::vector<BenchmarkCase> gridCases(int side, int pairs, std::uint64_t seed);

/// Returns the length [m] of the shortest path between the centres of two open cells, on a map that has only
/// open cells and blocked cells; infinite if there is no path.
double shortestAroundWalls_m(const costmap::CostGrid& map, maps::Cell from, maps::Cell to);

}  // namespace talus::planner
