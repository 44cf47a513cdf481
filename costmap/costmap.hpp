#pragma once

/// Umbrella header of talus::costmap: includes the traversability map, learning from wheel measurements, and
/// map files.

#include <talus/costmap/ground/ground_class.hpp>
#include <talus/costmap/map/explanation.hpp>
#include <talus/costmap/map/map_file.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/costmap/telemetry/drive_evidence.hpp>
