#pragma once

#include <string>

#include <talus/costmap/site/ground_site.hpp>

namespace talus::planner {

/// Loads a cost layer (additional cost per metre of each cell) from a shared library with a CostSource
/// (plugin_export.hpp), and evaluates the layer on `grid`. `file` is the path of the library, `name` the name
/// of the layer. The library is not trusted: it runs in a child process with limits of one minute and 4 GB.
/// If unknown ground is permitted, a cell with an unknown value costs as much as the most expensive cell of
/// the grid. Throws InputError with the file name if the library is not a layer plugin, was built for another
/// interface version, throws, crashes, or returns a wrong number of cells or an invalid value.
costmap::CostLayer layerFrom(const std::string& file, const std::string& name, const maps::Grid& grid);

}  // namespace talus::planner
