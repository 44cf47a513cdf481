#pragma once

#include <cstdint>
#include <string>

#include <talus/common/progress_monitor.hpp>
#include <talus/maps/sites/site_options.hpp>
#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// A made-up site: every layer on one grid.
struct Site {
  ElevationMap map;
  Raster<std::uint8_t> classes;  ///< SiteClass
  Raster<float> rock_abundance;  ///< share of ground under rocks [-]
};

/// Makes a site; a stop request throws nothing and leaves the map empty.
/// @throws std::invalid_argument on an option out of range
Site generateSite(const SiteOptions& options, const ProgressMonitor& watch = {});

}  // namespace talus::maps
