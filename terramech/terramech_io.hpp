#pragma once

/// Umbrella header of talus::terramech_io: reads soils, rovers and wheel models from YAML files and wheel
/// telemetry from CSV files.

#include <talus/terramech/io/model_file.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/io/telemetry_reader.hpp>
#include <talus/terramech/terramech.hpp>
