#pragma once

#include <string>
#include <vector>

#include <talus/planner/bench/benchmark.hpp>

namespace talus::planner {

/// Cases of a MovingAI scenario file (.scen) on its grid map (.map) [sturtevant_2012]: flat ground at 1 J/m,
/// cells of 1 m; characters other than '.', 'G' and 'S' are blocked cells; row 0 of the file is the northern
/// row. The optimum of the file is for eight grid headings, so an any-angle route may cost less. Reads at
/// most `most` cases, spread evenly over the file. Throws InputError with file, line, reason and remedy.
std::vector<BenchmarkCase> readMovingAi(const std::string& scenario_path, std::size_t most);

/// Map of uniform ground at 1 J/m, with blocked cells where `walls` is not 0.
std::shared_ptr<const costmap::CostGrid> evenGround(const maps::Raster<std::uint8_t>& walls);

}  // namespace talus::planner
