#pragma once

#include <string>
#include <vector>

#include <talus/planner/bench/benchmark.hpp>

namespace talus::planner {

/// Reads cases from a MovingAI scenario file (.scen) and its grid map (.map) [sturtevant_2012]. The ground is
/// level and costs 1 J/m; cells have a side length of 1 m. Characters other than '.', 'G' and 'S' are blocked
/// cells; row 0 of the file is the northern row. The optimum in the file is that of eight grid headings;
/// therefore a route with arbitrary headings may cost less. At most `most` cases are read, evenly distributed
/// over the file. Throws InputError with file, line, reason and remedy.
std::vector<BenchmarkCase> readMovingAi(const std::string& scenario_path, std::size_t most);

/// Returns a map of uniform ground at 1 J/m, with a blocked cell wherever `walls` is not 0.
std::shared_ptr<const costmap::CostGrid> evenGround(const maps::Raster<std::uint8_t>& walls);

}  // namespace talus::planner
