#pragma once

#include <cmath>

#include "drawn_map.hpp"

namespace talus::planner::testing {

/// A plane of 40 x 40 cells of one metre, too steep to climb or descend, whose contour line has the given
/// heading; only headings near the contour are allowed.
inline std::shared_ptr<const costmap::CostGrid> contourPlane(double contour_rad, double gradient = 0.42) {
  maps::Raster<costmap::CellCode> cells({.width = 40, .height = 40, .resolution_m = 1.0, .south_west = {}},
                                        costmap::CellCode({.dz_dx = -gradient * std::sin(contour_rad),
                                                           .dz_dy = gradient * std::cos(contour_rad),
                                                           .curve = 0}));
  return std::make_shared<costmap::CostGrid>(costmap::flattened(
      cells, std::make_shared<costmap::TravelCost>(
                 costmap::TravelCost::Limits{.max_along = 0.05, .max_across = 0.6}, std::vector{curve({})})));
}

}  // namespace talus::planner::testing
