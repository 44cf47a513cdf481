#pragma once

/// Umbrella header of Talus: sites from files, maps that learn, planners. Needs talus::site; a program without files
/// (GDAL, YAML) includes the umbrella header of each module that it uses instead.
#include <talus/planner/planner.hpp>
#include <talus/planner/site/site.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus {
using terramech::readTelemetry;
}  // namespace talus
