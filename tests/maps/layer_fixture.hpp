#pragma once

#include <string>

#include <talus/maps/maps_io.hpp>

#include "raster_fixture.hpp"

namespace talus::maps {

/// 4 x 3 cells of 10 m, UTM.
inline ElevationMap map(const TemporaryFolder& folder) {
  return readElevation(write({.rows = drawn({"1234", "2345", "3456"})}, folder / "dem.tif"));
}

/// The classes as a drawing, north on top; a dot for no class.
inline std::string drawing(const Raster<std::uint8_t>& classes) {
  std::string out;
  for (int row = classes.grid().height - 1; row >= 0; --row) {
    for (int column = 0; column < classes.grid().width; ++column) {
      const int value = classes[{column, row}];
      out += value == kNoClass ? '.' : static_cast<char>('0' + value);
    }
    out += '\n';
  }
  return out;
}

}  // namespace talus::maps
