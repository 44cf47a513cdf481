#pragma once

#include <cstdint>
#include <string>

#include <talus/common/progress_monitor.hpp>
#include <talus/maps/sites/landscape.hpp>
#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

/// A generated site: synthetic terrain for tests and simulations. All layers have the same grid.
struct Site {
  ElevationMap map;
  Raster<std::uint8_t> classes;  ///< terrain class of each cell, a number of SiteClass
  Raster<float> rock_abundance;  ///< fraction of the area covered by rocks [-]
};

/// Returns a site generated from `options`. After a stop request through `watch`, the returned site has an
/// empty map. @throws std::invalid_argument for an option out of range
Site generateSite(const SiteOptions& options, const ProgressMonitor& watch = {});

}  // namespace talus::maps
