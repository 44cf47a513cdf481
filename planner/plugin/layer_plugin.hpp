#pragma once

#include <string>

#include <talus/costmap/site/ground_site.hpp>

namespace talus::planner {

/// What a layer of somebody else's shared library (CostSource, plugin_export.hpp) adds over a grid, trusted in nothing: it
/// is loaded and asked in a child process, which may take a minute and 4 GB. Cells that it does not know cost as its
/// dearest of the grid where unknown ground is allowed. Throws InputError naming the file when it is no such plugin, was
/// built for another interface, throws, crashes, or answers with another number of cells or an impossible value.
costmap::CostLayer layerFrom(const std::string& file, const std::string& name, const maps::Grid& grid);

}  // namespace talus::planner
