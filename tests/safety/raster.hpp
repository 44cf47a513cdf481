#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// A checker of routes that shares no code with Talus: it reads files and uses its own formulas (README.md).
namespace safety {

/// A place on the map: x east, y north [m].
struct Place {
  double x_m = 0.0;
  double y_m = 0.0;
};

/// Column from the west, row from the south.
struct Cell {
  int column = 0;
  int row = 0;
};

/// One band of a raster, rows from south to north; NaN for cells without data.
struct Raster {
  int width = 0;
  int height = 0;
  double west_m = 0.0;
  double south_m = 0.0;
  double cell_m = 1.0;
  std::vector<double> values;

  bool holds(Cell c) const { return c.column >= 0 && c.row >= 0 && c.column < width && c.row < height; }
  double at(Cell c) const {
    return values[static_cast<std::size_t>(c.row) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(c.column)];
  }
  std::optional<Cell> cellAt(Place p) const;
  Place centre(Cell c) const {
    return {west_m + (c.column + 0.5) * cell_m, south_m + (c.row + 0.5) * cell_m};
  }
};

/// Reads the first band of a file with axis-aligned rows. Throws std::runtime_error.
Raster readRaster(const std::string& path);

/// Writes an ESRI ASCII grid; NaN is written as the no-data value.
void writeAscii(const Raster& raster, const std::string& path);

/// Returns the part of a raster that begins at a cell, in local coordinates.
Raster part(const Raster& raster, Cell south_west, int width, int height);

}  // namespace safety
