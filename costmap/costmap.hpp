#pragma once

/// Umbrella header of talus::costmap: includes the traversability map, learning from wheel measurements, and
/// map files.

#include <talus/costmap/ground/ground_class.hpp>
#include <talus/costmap/map.hpp>
#include <talus/costmap/map/map_file.hpp>
