#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace talus::maps {

/// A place on the map: x east, y north, in metres of the map's projection (or local metres where it has
/// none).
struct Point {
  double x_m = 0.0;
  double y_m = 0.0;

  friend bool operator==(const Point&, const Point&) = default;
};

/// Metres from one point to another.
inline double distance_m(Point a, Point b) noexcept {
  return std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
}

/// A cell by column (west to east) and row (south to north), both from 0.
struct Cell {
  int column = 0;
  int row = 0;

  friend bool operator==(const Cell&, const Cell&) = default;
};

/// A rectangle of cells, both corners included.
struct CellBox {
  Cell first;  ///< south-west
  Cell last;   ///< north-east
  int width() const noexcept { return last.column - first.column + 1; }
  int height() const noexcept { return last.row - first.row + 1; }
};

/// Where the square cells of a raster lie. Row 0 is the southernmost: y grows with the row.
struct Grid {
  int width = 0;              ///< cells west to east
  int height = 0;             ///< cells south to north
  double resolution_m = 1.0;  ///< side of a cell, > 0
  Point south_west{};         ///< outer corner of cell (0, 0)

  friend bool operator==(const Grid&, const Grid&) = default;

  std::size_t size() const noexcept {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }

  bool contains(Cell c) const noexcept {
    return c.column >= 0 && c.row >= 0 && c.column < width && c.row < height;
  }

  /// Position of the cell in a row-major array; the cell must lie inside.
  std::size_t index(Cell c) const noexcept {
    return static_cast<std::size_t>(c.row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(c.column);
  }

  Point centre(Cell c) const noexcept {
    return {south_west.x_m + (c.column + 0.5) * resolution_m, south_west.y_m + (c.row + 0.5) * resolution_m};
  }

  /// The cell that holds the point; nothing outside the map or for a NaN.
  std::optional<Cell> cellAt(Point p) const noexcept {
    const double column = std::floor((p.x_m - south_west.x_m) / resolution_m);
    const double row = std::floor((p.y_m - south_west.y_m) / resolution_m);
    if (!(column >= 0 && row >= 0 && column < width && row < height)) return std::nullopt;
    return Cell{static_cast<int>(column), static_cast<int>(row)};
  }
};

/// Values on a grid, row-major from the south-west corner.
template <typename T>
class Raster {
 public:
  Raster() = default;
  explicit Raster(const Grid& grid, T fill = T{}) : grid_(grid), values_(grid.size(), fill) {}

  /// Takes values that exist already. @throws std::invalid_argument unless there is one for each cell
  Raster(const Grid& grid, std::vector<T> values) : grid_(grid), values_(std::move(values)) {
    if (values_.size() != grid.size()) throw std::invalid_argument("raster: one value a cell is needed");
  }

  const Grid& grid() const noexcept { return grid_; }
  bool empty() const noexcept { return values_.empty(); }

  T& operator[](Cell c) noexcept { return values_[grid_.index(c)]; }
  const T& operator[](Cell c) const noexcept { return values_[grid_.index(c)]; }

  std::vector<T>& values() noexcept { return values_; }
  const std::vector<T>& values() const noexcept { return values_; }

  /// Start of a row of width values.
  T* row(int r) noexcept { return values_.data() + grid_.index({0, r}); }
  const T* row(int r) const noexcept { return values_.data() + grid_.index({0, r}); }

 private:
  Grid grid_;
  std::vector<T> values_;
};

}  // namespace talus::maps
