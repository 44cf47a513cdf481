#pragma once

/// Entry header of talus::costmap: the map of what is believed of each cell, how wheels teach it, and its file.

#include <talus/costmap/ground/ground_class.hpp>
#include <talus/costmap/map/explanation.hpp>
#include <talus/costmap/map/map_file.hpp>
#include <talus/costmap/map/map_tree.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/costmap/telemetry/drive_evidence.hpp>
