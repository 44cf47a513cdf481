#pragma once

/// Umbrella header of talus::terramech_io: reads soils, rovers and wheel models from YAML files and wheel
/// telemetry from CSV files.

#include <talus/terramech/io/terramech_io.hpp>
#include <talus/terramech/terramech.hpp>
