#include <algorithm>
#include <cmath>
#include <limits>

#include <talus/maps/grid/pixel_cover.hpp>

namespace talus::maps {
namespace {

constexpr double kTouch = 1e-3;  // smaller overlaps are ignored [cells]

using Corners = std::array<Point, 4>;

// True if a side of the pixel separates the pixel from the cell; coordinates in cells.
bool apart(const Corners& pixel, double turn, Cell cell) {
  for (std::size_t i = 0; i < pixel.size(); ++i) {
    const Point a = pixel[i], b = pixel[(i + 1) % pixel.size()];
    const double dx = b.x_m - a.x_m, dy = b.y_m - a.y_m, length = std::hypot(dx, dy);
    if (!(length > 0.0)) continue;
    double inward = -std::numeric_limits<double>::infinity();
    for (const int column : {cell.column, cell.column + 1})
      for (const int row : {cell.row, cell.row + 1})
        inward = std::max(inward, turn * (dx * (row - a.y_m) - dy * (column - a.x_m)) / length);
    if (inward <= kTouch) return true;
  }
  return false;
}

// 1 for corners in counter-clockwise order, -1 for clockwise.
double turnOf(const Corners& p) {
  double area = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Point a = p[i], b = p[(i + 1) % p.size()];
    area += a.x_m * b.y_m - b.x_m * a.y_m;
  }
  return area >= 0.0 ? 1.0 : -1.0;
}

struct Span {
  int first = 0, last = -1;
};

// Indices of the cells that the interval [least, most] overlaps; coordinates in cells.
Span span(double least, double most, int cells) {
  if (!(least < cells) || !(most > 0.0)) return {};
  return {std::max(0, static_cast<int>(std::floor(std::max(least, 0.0) + kTouch))),
          std::min(cells - 1, static_cast<int>(std::ceil(std::min(most, 1.0 * cells) - kTouch)) - 1)};
}

}  // namespace

PixelCover::PixelCover(const Grid& grid) : values_(grid, std::numeric_limits<float>::quiet_NaN()) {}

void PixelCover::add(const std::array<Point, 4>& corners, float value) {
  if (std::isnan(value)) return;
  const Grid& grid = values_.grid();
  Corners pixel = corners;
  Point least = {1e300, 1e300}, most = {-1e300, -1e300};
  for (Point& p : pixel) {
    if (!std::isfinite(p.x_m) || !std::isfinite(p.y_m)) return;
    p = {p.x_m / grid.resolution_m, p.y_m / grid.resolution_m};
    least = {std::min(least.x_m, p.x_m), std::min(least.y_m, p.y_m)};
    most = {std::max(most.x_m, p.x_m), std::max(most.y_m, p.y_m)};
  }
  const Span columns = span(least.x_m, most.x_m, grid.width), rows = span(least.y_m, most.y_m, grid.height);
  const double turn = turnOf(pixel);
  for (int row = rows.first; row <= rows.last; ++row)
    for (int column = columns.first; column <= columns.last; ++column) {
      float& greatest = values_[{column, row}];
      if (value <= greatest || apart(pixel, turn, {column, row})) continue;
      greatest = value;
    }
}

}  // namespace talus::maps
