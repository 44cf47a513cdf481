#pragma once

#include <string>

#include <talus/planner/site/site.hpp>

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

/// Declares the options --band, --resolution, --window, --nodata, --keep-holes, --vertical-scale,
/// --ignore-crs, --max-cells, --allow-vrt and --below.
void addReadOptions(CLI::App& command, ElevationFile& file);

/// Declares the positional argument `name` (default DEM) and the options of addReadOptions().
void addMapOptions(CLI::App& command, ElevationFile& file, const std::string& name = "DEM");

/// Declares the options --terrain, --terrain-band, --rocks, --rocks-band, --keep-out and --layer.
void addLayerOptions(CLI::App& command, SiteFiles& files);

/// Returns how a command reads a site: assumptions and repairs are printed as warnings.
SiteReading readingOf(const Context& context);

}  // namespace talus::cli
