#pragma once

#include <string>
#include <vector>

#include <talus/cli/ground/map_options.hpp>
#include <talus/costmap/ground/ground_model.hpp>

namespace talus::cli {

/// Ground of which only the cost per metre of each cell is known, the same in every heading. Its elevation is 0.
struct CostRaster {
  maps::ElevationMap map;
  maps::Raster<std::uint8_t> classes;  ///< class of each cell; kRefusedCost: impassable; maps::kNoClass: no data
  costmap::StatedCosts costs;          ///< by class: the value, or the upper end of a level of at most 3 %
};

/// Class number of cells that no heading may enter.
inline constexpr std::uint8_t kRefusedCost = 254;

/// Reads `options.path`: a raster of costs per metre, above 0, where infinite is impassable; or the YAML file of a Nav2
/// map (image, resolution, origin, negate, occupied_thresh, free_thresh), whose free cells cost 1 a metre and whose
/// occupied cells are impassable. @throws InputError
CostRaster readCostRaster(const MapOptions& options, const Context& context);

}  // namespace talus::cli
