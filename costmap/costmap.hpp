#pragma once

/// Entry header of talus::costmap: the map of what is believed of each cell, how wheels teach it, and its file.

#include <talus/costmap/drive_evidence.hpp>
#include <talus/costmap/explanation.hpp>
#include <talus/costmap/ground_class.hpp>
#include <talus/costmap/map_file.hpp>
#include <talus/costmap/traversability_map.hpp>
