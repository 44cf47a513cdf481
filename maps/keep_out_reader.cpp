#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <cpl_string.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <nlohmann/json.hpp>
#include <ogr_geometry.h>

#include <talus/maps/gdal_dataset.hpp>
#include <talus/maps/geojson.hpp>
#include <talus/maps/layer_reader.hpp>
#include <talus/maps/place.hpp>
#include <talus/talus.hpp>

namespace talus::maps {
namespace {

using nlohmann::json;

// What lies beyond a line across x or y moves onto its crossing (Sutherland and Hodgman 1974). An edge along the line is
// outside of the map: the box is wider.
std::vector<Point> cut(const std::vector<Point>& ring, double Point::*axis, double limit, double sign) {
  std::vector<Point> out;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &a = ring[i], &b = ring[(i + 1) % ring.size()];
    const double from = sign * (a.*axis - limit), to = sign * (b.*axis - limit);
    if (from <= 0.0) out.push_back(a);
    if ((from < 0.0) == (to < 0.0) || from == 0.0 || to == 0.0) continue;
    const double share = from / (from - to);
    Point crossing{a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m)};
    crossing.*axis = limit;
    out.push_back(crossing);
  }
  return out;
}

// The drawing of a ring loops over its rows: no vertex may lie far from the map.
std::vector<Point> clipped(std::vector<Point> ring, const Grid& grid) {
  const double around = 2.0 * grid.resolution_m;
  ring = cut(ring, &Point::x_m, grid.south_west.x_m - around, -1.0);
  ring = cut(ring, &Point::y_m, grid.south_west.y_m - around, -1.0);
  ring = cut(ring, &Point::x_m, grid.south_west.x_m + grid.width * grid.resolution_m + around, 1.0);
  return cut(ring, &Point::y_m, grid.south_west.y_m + grid.height * grid.resolution_m + around, 1.0);
}

std::unique_ptr<OGRLinearRing> ring(const json& positions, const PositionReader& read, const Grid& grid,
                                    const std::string& path) {
  if (!positions.is_array() || positions.size() < 4)
    throw InputError(
        {path, "a ring of a polygon has fewer than four positions", "close it on its first position"});
  std::vector<Point> points;
  for (const json& position : positions) points.push_back(read(position));
  auto out = std::make_unique<OGRLinearRing>();
  for (const Point& p : clipped(std::move(points), grid)) out->addPoint(p.x_m, p.y_m);
  out->closeRings();
  return out;
}

OGRPolygon polygon(const json& rings, const PositionReader& read, const Grid& grid, const std::string& path) {
  if (!rings.is_array() || rings.empty()) throw InputError({path, "a polygon has no ring", "see RFC 7946"});
  OGRPolygon out;
  for (const json& positions : rings) {
    auto whole = ring(positions, read, grid, path);
    const bool outer = &positions == &rings.front();
    if (whole->getNumPoints() >= 4)
      out.addRingDirectly(whole.release());
    else if (outer)
      break;  // no part of it is near the map
  }
  return out;
}

std::vector<OGRPolygon> polygons(const json& document, const PositionReader& read, const Grid& grid,
                                 const std::string& path) {
  std::vector<OGRPolygon> out;
  for (const json& geometry : geometries(document)) {
    const json& coordinates = geometry["coordinates"];
    if (geometry["type"] == "Polygon") {
      out.push_back(polygon(coordinates, read, grid, path));
    } else if (geometry["type"] == "MultiPolygon" && coordinates.is_array()) {
      for (const json& rings : coordinates) out.push_back(polygon(rings, read, grid, path));
    }
  }
  if (out.empty()) throw InputError({path, "holds no Polygon", "write the keep-out areas as polygons"});
  return out;
}

// Burns into rows that run south to north, like the map's.
void burn(const std::vector<OGRPolygon>& areas, Raster<std::uint8_t>& mask, const std::string& path) {
  const Grid& grid = mask.grid();
  const GdalErrors errors;
  const Dataset raster = memoryRaster(grid.width, grid.height, GDT_Byte);
  std::array<double, 6> transform{grid.south_west.x_m, grid.resolution_m, 0, grid.south_west.y_m, 0,
                                  grid.resolution_m};
  std::vector<OGRGeometryH> handles;
  for (const OGRPolygon& area : areas)
    if (area.getExteriorRing() != nullptr) handles.push_back(const_cast<OGRPolygon*>(&area));
  const std::vector<double> ones(handles.size(), 1.0);
  CPLStringList words;
  words.AddString("ALL_TOUCHED=TRUE");
  int band = 1;
  const bool done =
      raster && raster->SetGeoTransform(transform.data()) == CE_None &&
      GDALRasterizeGeometries(raster.get(), 1, &band, static_cast<int>(handles.size()), handles.data(),
                              nullptr, nullptr, ones.data(), words.List(), nullptr, nullptr) == CE_None &&
      raster->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, grid.width, grid.height, mask.values().data(),
                                         grid.width, grid.height, GDT_Byte, 0, 0, nullptr) == CE_None;
  if (!done) throw InputError({path, "cannot be drawn onto the map: " + errors.last(), ""});
}

}  // namespace

Raster<std::uint8_t> readKeepOut(const std::string& path, const ElevationMap& map) {
  const json document = readGeoJson(path);
  const std::vector<OGRPolygon> areas =
      polygons(document, PositionReader(document, map, path), map.grid(), path);
  Raster<std::uint8_t> mask(map.grid());
  burn(areas, mask, path);
  if (std::find(mask.values().begin(), mask.values().end(), 1) == mask.values().end())
    throw InputError({path, "no polygon overlaps map '" + map.source + "'", "the map " + extent(map.grid())});
  return mask;
}

}  // namespace talus::maps
