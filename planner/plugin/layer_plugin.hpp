#pragma once

#include <string>

#include <talus/costmap/site/ground_site.hpp>

namespace talus::planner {

/// Loads a cost layer from an external shared library (CostSource, plugin_export.hpp) and evaluates it on a
/// grid. The library is untrusted: it runs in a child process with limits of one minute and 4 GB. Unknown
/// cells cost as much as the most expensive cell of the grid if unknown ground is permitted. Throws
/// InputError with the file name if the library is not a layer plugin, was built for another interface
/// version, throws, crashes, or returns a wrong number of cells or an invalid value.
costmap::CostLayer layerFrom(const std::string& file, const std::string& name, const maps::Grid& grid);

}  // namespace talus::planner
