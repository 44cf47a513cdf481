#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <site_fixture.hpp>

#include <talus/costmap/costmap.hpp>

namespace talus::costmap {

/// A site from a drawing, north on top, one cell of one metre for each character, on a plane that rises by
/// `rise` per metre eastwards:
///   1 2 3 ... terrain class   ? no elevation   # keep-out
inline MapLayers drawn(const std::vector<std::string>& rows, double rise = 0.0) {
  const maps::Grid grid{.width = static_cast<int>(rows[0].size()),
                        .height = static_cast<int>(rows.size()),
                        .resolution_m = 1.0,
                        .south_west = {100.0, 200.0}};
  MapLayers layers;
  layers.elevation = {
      .elevation_m = maps::Raster<float>(grid), .georeference = {}, .source = "drawing", .notes = {}};
  layers.classes = maps::Raster<std::uint8_t>(grid, 1);
  layers.keep_out = maps::Raster<std::uint8_t>(grid, 0);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const maps::Cell cell{column, row};
      const char c = rows[static_cast<std::size_t>(grid.height - 1 - row)][static_cast<std::size_t>(column)];
      layers.elevation.elevation_m[cell] = c == '?' ? NAN : static_cast<float>(1000.0 + rise * column);
      if (c >= '0' && c <= '9') layers.classes[cell] = static_cast<std::uint8_t>(c - '0');
      if (c == '#') layers.keep_out[cell] = 1;
    }
  return layers;
}

/// The map of a drawing, sand as class 1 and dust as class 2.
inline TraversabilityMap mapOf(const std::vector<std::string>& rows, double rise = 0.0,
                               const TravelPolicy& policy = {}) {
  return TraversabilityMap(drawn(rows, rise), testGround(policy), {});
}

}  // namespace talus::costmap
