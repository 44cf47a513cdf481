#include <algorithm>
#include <cmath>
#include <limits>

#include <talus/maps/terrain/partial_plane.hpp>

namespace talus::maps {
namespace {

// Calls visit(dx, dy, height above the central cell) for each cell of the footprint with data.
void forEachValid(const Raster<float>& elevation_m, const Footprint& footprint, Cell cell,
                  const auto& visit) {
  const auto middle = static_cast<double>(elevation_m[cell]);
  for (const auto [dx, dy] : footprint.offsets) {
    const Cell c{cell.column + dx, cell.row + dy};
    if (!elevation_m.grid().contains(c) || std::isnan(elevation_m[c])) continue;
    visit(static_cast<double>(dx), static_cast<double>(dy), static_cast<double>(elevation_m[c]) - middle);
  }
}

struct Sums {
  double n = 0, x = 0, y = 0, h = 0, xx = 0, xy = 0, yy = 0, xh = 0, yh = 0;
};

Sums sums(const Raster<float>& elevation_m, const Footprint& footprint, Cell cell) {
  Sums s;
  forEachValid(elevation_m, footprint, cell, [&s](double x, double y, double h) {
    s.n += 1;
    s.x += x;
    s.y += y;
    s.h += h;
    s.xx += x * x;
    s.xy += x * y;
    s.yy += y * y;
    s.xh += x * h;
    s.yh += y * h;
  });
  return s;
}

}  // namespace

std::optional<PlaneFit> fitPartialPlane(const Raster<float>& elevation_m, const Footprint& footprint,
                                        Cell cell) {
  if (std::isnan(elevation_m[cell])) return std::nullopt;
  const Sums s = sums(elevation_m, footprint, cell);
  if (s.n < 4 || 4 * s.n < static_cast<double>(footprint.offsets.size())) return std::nullopt;
  // Normal equations relative to the mean.
  const double xx = s.xx - s.x * s.x / s.n;
  const double xy = s.xy - s.x * s.y / s.n;
  const double yy = s.yy - s.y * s.y / s.n;
  const double xh = s.xh - s.x * s.h / s.n;
  const double yh = s.yh - s.y * s.h / s.n;
  const double determinant = xx * yy - xy * xy;
  if (determinant < 1e-9) return std::nullopt;  // sums of integers: the determinant is 0 or of order 1
  const double east = (yy * xh - xy * yh) / determinant;
  const double north = (xx * yh - xy * xh) / determinant;
  const double base = (s.h - east * s.x - north * s.y) / s.n;
  double squares = 0;
  double highest = -std::numeric_limits<double>::infinity();
  double lowest = std::numeric_limits<double>::infinity();
  forEachValid(elevation_m, footprint, cell, [&](double x, double y, double h) {
    const double residual = h - base - east * x - north * y;
    squares += residual * residual;
    highest = std::max(highest, residual);
    lowest = std::min(lowest, residual);
  });
  const double resolution_m = elevation_m.grid().resolution_m;
  return PlaneFit{east / resolution_m, north / resolution_m, std::sqrt(squares / s.n), highest - lowest};
}

}  // namespace talus::maps
