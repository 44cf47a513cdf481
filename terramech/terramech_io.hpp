#pragma once

/// Main header of talus::terramech_io: soils, rovers and models from YAML, telemetry from CSV.

#include <talus/terramech/io/model_file.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/io/telemetry_reader.hpp>
#include <talus/terramech/terramech.hpp>
