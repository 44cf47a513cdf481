#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/planner/site/elevation_file.hpp>

/// Costs that are stated in place of a rover and soils.
namespace talus {

/// Costs per horizontal metre that a file states, by class number. `classed` is false for a file without a column
/// `class`; its one class has the number 0.
struct CostCurves {
  costmap::StatedCosts costs;
  std::vector<int> numbers;  ///< class numbers, ascending, in the order of costs.states
  bool classed = false;
};

/// Reads a cost per horizontal metre over gradients (rise over run) from a CSV file with the columns gradient_along
/// (climbing > 0), cost_per_m, and optionally gradient_across (>= 0, left and right equal) and class (0 to 254). Costs are
/// > 0; an empty field or inf refuses the gradients. Each class has all pairs of its gradients along and across, two
/// or more along, and across from 0. Costs are interpolated bilinearly; gradients beyond the table are refused, and so
/// is a gradient along above 1. Costs must not decrease with the gradient across. @throws InputError
CostCurves readCostCurves(const std::string& path);

/// Ground of which only the cost per metre of each cell is known, the same in every heading. Its elevation is 0.
struct CostRaster {
  maps::ElevationMap map;
  maps::Raster<std::uint8_t>
      classes;                 ///< class of each cell; kRefusedCost: impassable; maps::kNoClass: no data
  costmap::StatedCosts costs;  ///< by class: the value, or the upper end of a level of at most 3 %
};

/// Class number of cells that no heading may enter.
inline constexpr std::uint8_t kRefusedCost = 254;

/// Reads `file.path`: a raster of costs per metre, above 0, where infinite is impassable; or the YAML file of a Nav2
/// map (image, resolution, origin, negate, occupied_thresh, free_thresh), whose free cells cost 1 a metre and whose
/// occupied cells are impassable. @throws InputError
CostRaster readCostRaster(const ElevationFile& file, const SiteReading& reading);

}  // namespace talus
