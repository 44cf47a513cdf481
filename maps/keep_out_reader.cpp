#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

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

std::unique_ptr<OGRLinearRing> ring(const json& positions, const PositionReader& read,
                                    const std::string& path) {
  if (!positions.is_array() || positions.size() < 4)
    throw InputError(
        {path, "a ring of a polygon has fewer than four positions", "close it on its first position"});
  auto out = std::make_unique<OGRLinearRing>();
  for (const json& position : positions) {
    const Point p = read(position);
    out->addPoint(p.x_m, p.y_m);
  }
  out->closeRings();
  return out;
}

OGRPolygon polygon(const json& rings, const PositionReader& read, const std::string& path) {
  if (!rings.is_array() || rings.empty()) throw InputError({path, "a polygon has no ring", "see RFC 7946"});
  OGRPolygon out;
  for (const json& positions : rings) out.addRingDirectly(ring(positions, read, path).release());
  return out;
}

std::vector<OGRPolygon> polygons(const json& document, const PositionReader& read, const std::string& path) {
  std::vector<OGRPolygon> out;
  for (const json& geometry : geometries(document)) {
    const json& coordinates = geometry["coordinates"];
    if (geometry["type"] == "Polygon") {
      out.push_back(polygon(coordinates, read, path));
    } else if (geometry["type"] == "MultiPolygon" && coordinates.is_array()) {
      for (const json& rings : coordinates) out.push_back(polygon(rings, read, path));
    }
  }
  if (out.empty()) throw InputError({path, "holds no Polygon", "write the keep-out areas as polygons"});
  return out;
}

// Burns into rows that run south to north, like the map's.
void burn(const std::vector<OGRPolygon>& areas, Raster<std::uint8_t>& mask, const std::string& path) {
  const Grid& grid = mask.grid();
  const GdalErrors errors;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  const Dataset raster(driver->Create("", grid.width, grid.height, 1, GDT_Byte, nullptr));
  std::array<double, 6> transform{grid.south_west.x_m, grid.resolution_m, 0, grid.south_west.y_m, 0,
                                  grid.resolution_m};
  std::vector<OGRGeometryH> handles;
  for (const OGRPolygon& area : areas) handles.push_back(const_cast<OGRPolygon*>(&area));
  const std::vector<double> ones(areas.size(), 1.0);
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
  const std::vector<OGRPolygon> areas = polygons(document, PositionReader(document, map, path), path);
  Raster<std::uint8_t> mask(map.grid());
  GDALAllRegister();
  burn(areas, mask, path);
  if (std::find(mask.values().begin(), mask.values().end(), 1) == mask.values().end())
    throw InputError({path, "no polygon overlaps map '" + map.source + "'", "the map " + extent(map.grid())});
  return mask;
}

}  // namespace talus::maps
