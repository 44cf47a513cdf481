#pragma once

#include <cstdint>
#include <string>

#include <talus/common/progress_monitor.hpp>
#include <talus/maps/sites/site_options.hpp>
#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// A generated site; all layers have the same grid.
struct Site {
  ElevationMap map;
  Raster<std::uint8_t> classes;  ///< SiteClass
  Raster<float> rock_abundance;  ///< fraction of the area covered by rocks [-]
};

/// Generates a site. After a stop request, the returned site has an empty map. @throws std::invalid_argument
/// for an option out of range
Site generateSite(const SiteOptions& options, const ProgressMonitor& watch = {});

}  // namespace talus::maps
