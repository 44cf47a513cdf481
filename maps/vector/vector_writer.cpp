#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <talus/common/common.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/raster_frame.hpp>
#include <talus/maps/vector/vector_writer.hpp>

namespace talus::maps {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kDocument = "DOCUMENT";
constexpr const char* kDomain = "TALUS";  // metadata domain; programs list only the default domain

OGRFieldType fieldTypeOf(const Json& value) {
  if (value.is_string()) return OFTString;
  if (value.is_boolean()) return OFTInteger;
  return value.is_number_integer() ? OFTInteger64 : OFTReal;
}

void setField(OGRFeature& feature, const std::string& name, const Json& value) {
  const int field = feature.GetFieldIndex(name.c_str());
  if (field < 0) return;
  if (value.is_string())
    feature.SetField(field, value.get_ref<const std::string&>().c_str());
  else if (value.is_boolean())
    feature.SetField(field, value.get<bool>() ? 1 : 0);
  else if (value.is_number_integer())
    feature.SetField(field, value.get<GIntBig>());
  else if (value.is_number() && std::isfinite(value.get<double>()))
    feature.SetField(field, value.get<double>());
}

// Converts positions to the CRS of the file.
class Placer {
 public:
  Placer(const std::string& driver, const ElevationMap& map, const std::string& path)
      : places_(driver == "GPKG" ? nullptr : map.places()) {
    if (driver == "GPKG") {
      if (map.georeference) crs_ = spatialReference(map.georeference->system());
      return;
    }
    requireWritable(driver, map, path);
    crs_.emplace().SetWellKnownGeogCS("WGS84");
    crs_->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  }

  const OGRSpatialReference* crs() const { return crs_ ? &*crs_ : nullptr; }

  OGRPoint operator()(const VectorPosition& position) const {
    Point at = position.at;
    if (places_ != nullptr) {
      const GeoPoint place = places_->reverse(at);
      at = {place.longitude_rad / kDegree, place.latitude_rad / kDegree};
    }
    return std::isfinite(position.elevation_m) ? OGRPoint(at.x_m, at.y_m, position.elevation_m)
                                               : OGRPoint(at.x_m, at.y_m);
  }

 private:
  const Georeference* places_;
  std::optional<OGRSpatialReference> crs_{};
};

void writeLayer(GDALDataset& file, const VectorLayer& layer, const Placer& placed, bool own_fields) {
  const std::size_t positions = layer.features.front().positions.size();
  constexpr OGRwkbGeometryType kTypes[] = {wkbNone, wkbPoint25D, wkbLineString25D};
  const char* options[] = {"FORCE_GPX_TRACK=YES", nullptr};
  OGRLayer* out = file.CreateLayer(
      layer.name.c_str(), const_cast<OGRSpatialReference*>(positions > 0 ? placed.crs() : nullptr),
      kTypes[std::min<std::size_t>(positions, 2)], own_fields ? nullptr : const_cast<char**>(options));
  if (out == nullptr) return;
  for (const auto& [name, value] : layer.features.front().fields.items()) {
    OGRFieldDefn field(name.c_str(), fieldTypeOf(value));
    if (value.is_boolean()) field.SetSubType(OFSTBoolean);
    if (own_fields) out->CreateField(&field);
  }
  for (const VectorFeature& feature : layer.features) {
    OGRFeature row(out->GetLayerDefn());
    for (const auto& [name, value] : feature.fields.items()) setField(row, name, value);
    OGRLineString line;
    OGRPoint point;
    for (const VectorPosition& position : feature.positions) {
      point = placed(position);
      line.addPoint(&point);
    }
    if (positions > 0) row.SetGeometry(positions == 1 ? static_cast<OGRGeometry*>(&point) : &line);
    if (out->CreateFeature(&row) != OGRERR_NONE) return;
  }
}

}  // namespace

void requireWritable(const std::string& driver, const ElevationMap& map, const std::string& path) {
  if (driver == "GPKG") return;
  const std::string only = driver + " has places of Earth in WGS 84 alone, and the map ";
  if (map.places() == nullptr)
    throw InputError({path, only + "has no CRS", "write a GeoPackage (.gpkg) or CSV"});
  if (map.georeference->body() != bodyName(kEarth))
    throw InputError({path, only + "is of " + map.georeference->body(),
                      "write a GeoPackage (.gpkg), which has the CRS of the map"});
}

std::string vectorFile(const std::string& driver, const ElevationMap& map,
                       const std::vector<VectorLayer>& layers, const std::string& path,
                       const std::string& document) {
  const Placer placed(driver, map, path);
  GDALDriver& format = driverNamed(driver.c_str());
  const GdalErrors errors;
  // Fixed date instead of the current time: the same route gives the same bytes.
  const CPLConfigOptionSetter date("OGR_CURRENT_DATE", "1970-01-01T00:00:00.000Z", false);
  const MemoryFile memory(driver == "GPKG" ? "gpkg" : driver == "GPX" ? "gpx" : "kml");
  {
    const char* options[] = {"NameField=name", nullptr};
    const GDALDatasetUniquePtr file(format.Create(memory.name.c_str(), 0, 0, 0, GDT_Unknown,
                                                  driver == "KML" ? const_cast<char**>(options) : nullptr));
    for (const VectorLayer& layer : layers)
      if (file && !layer.features.empty()) writeLayer(*file, layer, placed, driver != "GPX");
    if (file && !document.empty()) file->SetMetadataItem(kDocument, document.c_str(), kDomain);
  }
  if (errors.any()) throw InputError({path, "GDAL cannot write it: " + errors.last(), "write GeoJSON"});
  return std::string(memory.bytes());
}

std::string areaFile(const ElevationMap& map, const Raster<std::uint8_t>& inside, const std::string& name,
                     const std::string& path) {
  if (!path.ends_with(".gpkg"))
    throw InputError({path, "areas are written as GeoPackage", "name a file .gpkg"});
  const Grid& grid = inside.grid();
  const Placer placed("GPKG", map, path);
  const GdalErrors errors;
  const CPLConfigOptionSetter date("OGR_CURRENT_DATE", "1970-01-01T00:00:00.000Z", false);
  const Dataset cells(driverNamed("MEM").Create("", grid.width, grid.height, 1, GDT_Byte, nullptr));
  GDALRasterBand& band = *cells->GetRasterBand(1);
  for (int row = 0; row < grid.height; ++row) {  // GDAL's first row is the northernmost
    auto* values = const_cast<std::uint8_t*>(&inside[{0, grid.height - 1 - row}]);
    if (band.RasterIO(GF_Write, 0, row, grid.width, 1, values, grid.width, 1, GDT_Byte, 0, 0) != CE_None)
      break;
  }
  double transform[] = {
      grid.south_west.x_m, grid.resolution_m, 0.0, grid.south_west.y_m + grid.height * grid.resolution_m, 0.0,
      -grid.resolution_m};
  cells->SetGeoTransform(transform);
  const MemoryFile memory("gpkg");
  {
    const GDALDatasetUniquePtr file(
        driverNamed("GPKG").Create(memory.name.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    OGRLayer* layer =
        file ? file->CreateLayer(name.c_str(), const_cast<OGRSpatialReference*>(placed.crs()), wkbPolygon)
             : nullptr;
    if (layer) GDALPolygonize(&band, &band, layer, -1, nullptr, nullptr, nullptr);
  }
  if (errors.any()) throw InputError({path, "GDAL cannot write it: " + errors.last(), "check the disk"});
  return std::string(memory.bytes());
}

StoredDocument storedDocument(const std::string& path) {
  const Dataset file = openVector(path);
  const GdalErrors errors;
  const char* document = file->GetMetadataItem(kDocument, kDomain);
  if (document == nullptr || file->GetLayerCount() == 0)
    throw InputError({path, "contains no route of talus plan", "pass a route from `talus plan -o`"});
  StoredDocument out{.document = document, .line = {}};
  const OGRFeatureUniquePtr first(file->GetLayer(0)->GetNextFeature());
  const OGRGeometry* drawn = first ? first->GetGeometryRef() : nullptr;
  if (drawn != nullptr && wkbFlatten(drawn->getGeometryType()) == wkbLineString)
    for (const OGRPoint& point : drawn->toLineString()) out.line.push_back({point.getX(), point.getY()});
  if (errors.any()) throw InputError({path, "is damaged: " + errors.last(), "write it again"});
  return out;
}

}  // namespace talus::maps
