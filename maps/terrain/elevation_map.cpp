#include <algorithm>
#include <cmath>

#include <talus/maps/terrain/elevation_map.hpp>

namespace talus::maps {

double validFraction(const Raster<float>& elevation_m) {
  const auto& z = elevation_m.values();
  if (z.empty()) return 0.0;
  const auto valid = std::count_if(z.begin(), z.end(), [](float v) { return !std::isnan(v); });
  return static_cast<double>(valid) / static_cast<double>(z.size());
}

std::optional<double> elevationAt(const Raster<float>& elevation_m, Point point) {
  return elevationAt(elevation_m.grid(), point, [&](Cell cell) { return elevation_m[cell]; });
}

std::optional<double> elevationAt(const Grid& grid, Point point,
                                  const std::function<float(Cell)>& elevation_m) {
  if (!grid.cellAt(point)) return std::nullopt;
  // Column and row of the point [cells] from the centre of cell (0, 0), clamped: within half a cell of the
  // border, the elevation is that of the border cells.
  const double column =
      std::clamp((point.x_m - grid.south_west.x_m) / grid.resolution_m - 0.5, 0.0, grid.width - 1.0);
  const double row =
      std::clamp((point.y_m - grid.south_west.y_m) / grid.resolution_m - 0.5, 0.0, grid.height - 1.0);
  const Cell sw{static_cast<int>(column), static_cast<int>(row)};
  const Cell ne{std::min(sw.column + 1, grid.width - 1), std::min(sw.row + 1, grid.height - 1)};
  const double u = column - sw.column;
  const double v = row - sw.row;
  const auto z = [&](int c, int r) { return static_cast<double>(elevation_m({c, r})); };
  // A corner with weight 0 may be without data.
  const auto mix = [](double a, double b, double t) { return t == 0 ? a : a + (b - a) * t; };
  const double south = mix(z(sw.column, sw.row), z(ne.column, sw.row), u);
  const double value = v == 0 ? south : mix(south, mix(z(sw.column, ne.row), z(ne.column, ne.row), u), v);
  if (std::isnan(value)) return std::nullopt;
  return value;
}

}  // namespace talus::maps
