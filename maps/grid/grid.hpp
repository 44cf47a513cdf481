#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace talus::maps {

/// A point in map coordinates [m], with x east and y north. Map coordinates are projected coordinates, or
/// local coordinates in metres for a map without a projection.
struct Point {
  double x_m = 0.0;
  double y_m = 0.0;

  friend bool operator==(const Point&, const Point&) = default;
};

/// Returns the Euclidean distance [m] between two points.
inline double distance_m(Point a, Point b) noexcept {
  return std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
}

/// The index of a cell in a grid: the column from west to east and the row from south to north, both counted
/// from 0.
struct Cell {
  int column = 0;
  int row = 0;

  friend bool operator==(const Cell&, const Cell&) = default;
};

/// A rectangle of cells, including both corner cells.
struct CellBox {
  Cell first;  ///< south-west cell
  Cell last;   ///< north-east cell
  int width() const noexcept { return last.column - first.column + 1; }
  int height() const noexcept { return last.row - first.row + 1; }
};

/// Geometry of a raster of square cells. Row 0 is the southernmost row: y increases with the row.
struct Grid {
  int width = 0;              ///< number of columns
  int height = 0;             ///< number of rows
  double resolution_m = 1.0;  ///< side length of a cell, > 0
  Point south_west{};         ///< map coordinates of the south-west corner of cell (0, 0)

  friend bool operator==(const Grid&, const Grid&) = default;

  /// Returns the number of cells.
  std::size_t size() const noexcept {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }

  /// Returns true if the cell lies inside the grid.
  bool contains(Cell c) const noexcept {
    return c.column >= 0 && c.row >= 0 && c.column < width && c.row < height;
  }

  /// Returns the index of the cell in a row-major array. The cell must lie inside the grid.
  std::size_t index(Cell c) const noexcept {
    return static_cast<std::size_t>(c.row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(c.column);
  }

  /// Returns the map coordinates of the centre of a cell.
  Point centre(Cell c) const noexcept {
    return {south_west.x_m + (c.column + 0.5) * resolution_m, south_west.y_m + (c.row + 0.5) * resolution_m};
  }

  /// Returns the cell that contains the point; nullopt for a point outside the grid or with a NaN coordinate.
  std::optional<Cell> cellAt(Point p) const noexcept {
    const double column = std::floor((p.x_m - south_west.x_m) / resolution_m);
    const double row = std::floor((p.y_m - south_west.y_m) / resolution_m);
    if (!(column >= 0 && row >= 0 && column < width && row < height)) return std::nullopt;
    return Cell{static_cast<int>(column), static_cast<int>(row)};
  }
};

/// A raster: one value for each cell of a grid, in row-major order from the south-west corner.
template <typename T>
class Raster {
 public:
  Raster() = default;
  /// Makes a raster with the value `fill` in every cell.
  explicit Raster(const Grid& grid, T fill = T{}) : grid_(grid), values_(grid.size(), fill) {}

  /// Makes a raster from existing values in row-major order. @throws std::invalid_argument unless there is
  /// one value for each cell
  Raster(const Grid& grid, std::vector<T> values) : grid_(grid), values_(std::move(values)) {
    if (values_.size() != grid.size()) throw std::invalid_argument("raster: one value a cell is needed");
  }

  const Grid& grid() const noexcept { return grid_; }
  bool empty() const noexcept { return values_.empty(); }

  T& operator[](Cell c) noexcept { return values_[grid_.index(c)]; }
  const T& operator[](Cell c) const noexcept { return values_[grid_.index(c)]; }

  std::vector<T>& values() noexcept { return values_; }
  const std::vector<T>& values() const noexcept { return values_; }

  /// Returns a pointer to the first of the `width` values of row r.
  T* row(int r) noexcept { return values_.data() + grid_.index({0, r}); }
  const T* row(int r) const noexcept { return values_.data() + grid_.index({0, r}); }

 private:
  Grid grid_;
  std::vector<T> values_;
};

}  // namespace talus::maps
