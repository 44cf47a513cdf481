#pragma once

#include <cstdint>
#include <string>
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

/// Reads cases from a MovingAI scenario file (.scen) and its grid map (.map) [sturtevant_2012]. The ground is
/// level and costs 1 J/m; cells have a side length of 1 m. Characters other than '.', 'G' and 'S' are blocked
/// cells; row 0 of the file is the northern row. The optimum in the file is that of eight grid headings;
/// therefore a route with arbitrary headings may cost less. At most `most` cases are read, evenly distributed
/// over the file. Throws InputError with file, line, reason and remedy.
std::vector<BenchmarkCase> readMovingAi(const std::string& scenario_path, std::size_t most);

/// Returns a map of uniform ground at 1 J/m, with a blocked cell wherever `walls` is not 0.
std::shared_ptr<const costmap::CostGrid> evenGround(const maps::Raster<std::uint8_t>& walls);

}  // namespace talus::planner
