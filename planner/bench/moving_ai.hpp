#pragma once

#include <string>
#include <vector>

#include <talus/planner/bench/benchmark.hpp>

namespace talus::planner {

/// Cases of a MovingAI scenario file (.scen) over its grid map (.map) [sturtevant_2012]: flat ground at 1 J a
/// metre, cells of 1 m, what is not '.', 'G' or 'S' blocked; row 0 of the file is the north. A file's optimum
/// is of a grid's eight headings, so an any-angle route may cost less. Takes at most `most` cases, spread
/// evenly over the file. Throws InputError naming file, line, reason and remedy.
std::vector<BenchmarkCase> readMovingAi(const std::string& scenario_path, std::size_t most);

/// A map of even ground at one joule a metre but for the cells that are not 0, which are blocked.
std::shared_ptr<const costmap::CostGrid> evenGround(const maps::Raster<std::uint8_t>& walls);

}  // namespace talus::planner
