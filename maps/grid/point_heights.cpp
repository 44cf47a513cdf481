#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <talus/maps/maps.hpp>

namespace talus::maps {

Raster<float> heightsOf(std::span<const CloudPoint> points, const Grid& grid, const HeightChoice& choice) {
  if (!(choice.percentile > 0.0 && choice.percentile <= 1.0))
    throw std::invalid_argument("point cloud: percentile = " + std::to_string(choice.percentile) +
                                ", must be above 0 and at most 1");
  if (choice.least_points < 1) throw std::invalid_argument("point cloud: least_points = 0, must be >= 1");
  std::vector<std::pair<std::size_t, float>> found;
  for (const CloudPoint& point : points)
    if (const auto cell = grid.cellAt({point.x_m, point.y_m});
        cell && std::isfinite(static_cast<float>(point.z_m)))
      found.emplace_back(grid.index(*cell), static_cast<float>(point.z_m));
  std::ranges::sort(found);
  Raster<float> heights(grid, std::numeric_limits<float>::quiet_NaN());
  bool any = false;
  for (auto first = found.begin(); first != found.end();) {
    const auto last =
        std::find_if(first, found.end(), [&](const auto& p) { return p.first != first->first; });
    const auto count = static_cast<std::size_t>(last - first);
    if (count >= choice.least_points) {
      const double rank = std::ceil(choice.percentile * static_cast<double>(count) - 1e-9);
      const std::size_t place = std::clamp<std::size_t>(static_cast<std::size_t>(rank), 1, count) - 1;
      heights.values()[first->first] = (first + static_cast<std::ptrdiff_t>(place))->second;
      any = true;
    }
    first = last;
  }
  if (!any)
    throw std::invalid_argument(
        "point cloud: no cell of the grid has " + std::to_string(choice.least_points) + " of its " +
        std::to_string(points.size()) + " points; give them in the map's frame, or lower least_points");
  return heights;
}

}  // namespace talus::maps
