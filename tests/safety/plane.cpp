#include "plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace safety {
namespace {

struct Height {
  double x_m, y_m, z_m;
};

// Returns the heights of the disc's cells with data; `whole` counts all cells of the disc.
std::vector<Height> heightsUnder(const Raster& elevation_m, Cell cell, double radius_m, int& whole) {
  const double side = elevation_m.cell_m;
  const double reach_m = std::max(radius_m, std::sqrt(2.0) * side) * (1.0 + 1e-9);
  const int reach = static_cast<int>(reach_m / side);
  std::vector<Height> found;
  for (int row = -reach; row <= reach; ++row)
    for (int column = -reach; column <= reach; ++column) {
      if (std::hypot(column, row) * side > reach_m) continue;
      ++whole;
      const Cell there{cell.column + column, cell.row + row};
      if (elevation_m.holds(there) && !std::isnan(elevation_m.at(there)))
        found.push_back({column * side, row * side, elevation_m.at(there)});
    }
  return found;
}

using Equations = std::array<std::array<double, 4>, 3>;

// Gaussian elimination with pivoting; false if the heights lie on a line.
bool solve(Equations& a) {
  for (std::size_t k = 0; k < 3; ++k) {
    std::size_t best = k;
    for (std::size_t i = k; i < 3; ++i)
      if (std::abs(a[i][k]) > std::abs(a[best][k])) best = i;
    std::swap(a[k], a[best]);
    if (std::abs(a[k][k]) < 1e-12) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      if (i == k) continue;
      const double factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < 4; ++j) a[i][j] -= factor * a[k][j];
    }
  }
  return true;
}

}  // namespace

Plane planeUnder(const Raster& elevation_m, Cell cell, double radius_m) {
  Plane plane;
  int whole = 0;
  const auto heights = heightsUnder(elevation_m, cell, radius_m, whole);
  plane.cells = static_cast<int>(heights.size());
  const bool here = elevation_m.holds(cell) && !std::isnan(elevation_m.at(cell));
  if (!here || 4 * plane.cells < whole) return plane;
  const double datum_m = elevation_m.at(cell);
  Equations a{};
  for (const Height& h : heights) {
    const std::array<double, 4> row{1.0, h.x_m, h.y_m, h.z_m - datum_m};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 4; ++j) a[i][j] += row[i] * row[j];
  }
  if (!solve(a)) return plane;
  const double level = a[0][3] / a[0][0];
  plane.east = a[1][3] / a[1][1];
  plane.north = a[2][3] / a[2][2];
  plane.known = true;
  double low = 1e300, high = -1e300, squares = 0.0;
  for (const Height& h : heights) {
    const double left_m = h.z_m - datum_m - level - plane.east * h.x_m - plane.north * h.y_m;
    low = std::min(low, left_m);
    high = std::max(high, left_m);
    squares += left_m * left_m;
  }
  plane.relief_m = high - low;
  plane.roughness_m = std::sqrt(squares / static_cast<double>(heights.size()));
  return plane;
}

}  // namespace safety
