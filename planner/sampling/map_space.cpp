#include <cmath>
#include <limits>

#include <ompl/base/spaces/RealVectorStateProjections.h>

#include <talus/planner/sampling/map_space.hpp>

namespace talus::planner {
namespace {

// The map's east and north edges belong to no cell, so the largest coordinate lies just inside.
double lastInside(double edge) {
  return std::nextafter(edge, -std::numeric_limits<double>::infinity());
}

}  // namespace

MapSpace::MapSpace(const maps::Grid& grid) : RealVectorStateSpace(2), grid_(grid) {
  setName("Map");
  setDimensionName(0, "x_m");
  setDimensionName(1, "y_m");
  ompl::base::RealVectorBounds bounds(2);
  bounds.setLow(0, grid.south_west.x_m);
  bounds.setLow(1, grid.south_west.y_m);
  bounds.setHigh(0, lastInside(grid.south_west.x_m + grid.width * grid.resolution_m));
  bounds.setHigh(1, lastInside(grid.south_west.y_m + grid.height * grid.resolution_m));
  setBounds(bounds);
}

void MapSpace::registerProjections() {
  constexpr double side_cells = 16.0;
  const std::vector<double> sizes(2, side_cells * grid_.resolution_m);
  registerDefaultProjection(std::make_shared<ompl::base::RealVectorIdentityProjectionEvaluator>(this, sizes));
}

}  // namespace talus::planner
