#include <algorithm>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string_view>

#include <cpl_conv.h>
#include <gdal_priv.h>
#include <nlohmann/json.hpp>
#include <ogr_api.h>
#include <ogrsf_frmts.h>

#include <talus/common/input_error.hpp>
#include <talus/common/memory_budget.hpp>
#include <talus/maps/raster/file_text.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/spatial_reference.hpp>
#include <talus/maps/vector/geojson.hpp>
#include <talus/maps/vector/vector_reader.hpp>

namespace talus::maps {
namespace {

using nlohmann::json;

// A position of 16 bytes needs about 120 bytes as JSON, and temporarily memory for its text.
constexpr double kMemoryPerWkbByte = 12.0;
constexpr std::size_t kWkbBytesPerPosition = 16;

bool beginsAsJson(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  char c = ' ';
  while (std::isspace(static_cast<unsigned char>(c)) != 0 && file.get(c)) continue;
  return c == '{' || c == '[';
}

// Returns true for GDAL's GPX layers that repeat the points of routes and tracks.
bool isCopy(const std::string& layer) {
  return layer == "route_points" || layer == "track_points";
}

// Reads layers of one file and transforms each from its CRS to that of the map.
class FeatureReader {
 public:
  FeatureReader(const ElevationMap& map, const std::string& path, const FeatureVisitor& visit)
      : map_(map), path_(path), visit_(visit) {}

  void read(OGRLayer& layer) {
    if (layer.GetGeomType() == wkbNone) return;
    const auto to_map = transformationOf(layer);
    for (const auto& feature : layer) {
      ++features_;
      visit_(nameOf(*feature), inMetres(*feature, to_map.get()).get());
      refuseDamage();
    }
    refuseDamage();
  }

  std::size_t features() const { return features_; }

 private:
  void refuseDamage() const {
    if (errors_.any()) throw InputError({path_, "is damaged: " + errors_.last(), "write it again"});
  }

  using Transformation = std::unique_ptr<OGRCoordinateTransformation>;

  static std::string nameOf(const OGRFeature& feature) {
    const int field = feature.GetFieldIndex("name");
    return field < 0 ? "" : feature.GetFieldAsString(field);
  }

  // Transformation to the map's CRS; null if both are in local metres.
  Transformation transformationOf(const OGRLayer& layer) const {
    const OGRSpatialReference* stated = const_cast<OGRLayer&>(layer).GetSpatialRef();
    const std::string name = stated != nullptr && stated->GetName() != nullptr ? stated->GetName() : "";
    // GeoPackages without a CRS contain an "Undefined geographic SRS".
    const bool usable = stated != nullptr && (stated->IsProjected() != 0 || stated->IsGeographic() != 0) &&
                        !name.starts_with("Undefined ");
    const std::string owner =
        "layer '" + std::string(const_cast<OGRLayer&>(layer).GetName()).substr(0, 80) + "' ";
    if (!map_.georeference && !usable) return nullptr;
    if (!usable)
      throw InputError(
          {path_, owner + "has no CRS, and the map has one", "state it with ogr2ogr -a_srs CRS"});
    if (!map_.georeference)
      throw InputError(
          {path_, owner + "is in '" + name + "', and the map has no CRS", "draw it in map metres"});
    const std::string body = bodyName({stated->GetSemiMajor(), 0.0});
    if (body != map_.georeference->body())
      throw InputError(
          {path_,
           owner + "is in '" + name + "' of " + body + ", and the map is of " + map_.georeference->body(),
           "draw it in the CRS of the map; GPX and KML have places of Earth alone"});
    OGRSpatialReference from(*stated);
    from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const OGRSpatialReference to = spatialReference(map_.georeference->system());
    Transformation made(OGRCreateCoordinateTransformation(&from, &to));
    if (!made)
      throw InputError(
          {path_, owner + "cannot be brought from '" + name + "' to the map's CRS", "transform it"});
    return made;
  }

  std::unique_ptr<OGRGeometry> inMetres(OGRFeature& feature, OGRCoordinateTransformation* to_map) const {
    std::unique_ptr<OGRGeometry> drawn(feature.StealGeometry());
    if (!drawn) return drawn;
    if (drawn->hasCurveGeometry()) drawn.reset(drawn->getLinearGeometry());
    drawn->flattenTo2D();
    if (to_map != nullptr && drawn->transform(to_map) != OGRERR_NONE)
      throw InputError(
          {path_, "has a position outside the range of the map's CRS: " + errors_.last(), "check its CRS"});
    return drawn;
  }

  const ElevationMap& map_;
  const std::string& path_;
  const FeatureVisitor& visit_;
  const GdalErrors errors_{};
  std::size_t features_ = 0;
};

json asJson(const OGRGeometry& drawn) {
  const char* options[] = {"COORDINATE_PRECISION=17", nullptr};
  const std::unique_ptr<char, decltype(&CPLFree)> text(
      OGR_G_ExportToJsonEx(OGRGeometry::ToHandle(const_cast<OGRGeometry*>(&drawn)),
                           const_cast<char**>(options)),
      CPLFree);
  return text ? json::parse(text.get(), nullptr, false) : json();
}

}  // namespace

std::optional<json> visitVector(const std::string& path, const ElevationMap& map,
                                const FeatureVisitor& visit) {
  requireReadableFile(path);
  if (beginsAsJson(path))
    if (json document = readGeoJson(path); !map.georeference || !namesProjectedCrs(document)) return document;
  const Dataset file = openVector(path);
  FeatureReader reader(map, path, visit);
  for (OGRLayer* layer : file->GetLayers())
    if (!isCopy(layer->GetName())) reader.read(*layer);
  if (reader.features() == 0)
    throw InputError({path, "contains no feature", "draw the places, lines or areas in it"});
  return std::nullopt;
}

json readVector(const std::string& path, const ElevationMap& map) {
  json features = json::array();
  std::size_t bytes = 0;
  auto document = visitVector(path, map, [&](const std::string& name, const OGRGeometry* drawn) {
    bytes += drawn == nullptr ? 0 : drawn->WkbSize();
    requireFewPositions(bytes / kWkbBytesPerPosition, path);
    requireMemory(kMemoryPerWkbByte * static_cast<double>(bytes), path);
    features.push_back({{"type", "Feature"},
                        {"properties", {{"name", name}}},
                        {"geometry", drawn == nullptr ? json() : asJson(*drawn)}});
  });
  if (document) return std::move(*document);
  return {{"type", "FeatureCollection"}, {"crs", "local"}, {"features", std::move(features)}};
}

void requireFewPositions(std::size_t positions, const std::string& path) {
  constexpr std::size_t kMost = 1'000'000;
  if (positions > kMost)
    throw InputError({path, "contains " + std::to_string(positions) + " positions, more than a million",
                      "simplify its lines, as by ogr2ogr -simplify METRES OUT IN, or split it"});
}

bool isNamedAsVector(const std::string& path) {
  constexpr std::string_view kEndings[] = {".geojson", ".json", ".gpkg", ".shp", ".fgb",
                                           ".gpx",     ".kml",  ".tab",  ".mif"};
  const std::string name = lower(path);
  return std::ranges::any_of(kEndings, [&](std::string_view ending) { return name.ends_with(ending); });
}

}  // namespace talus::maps
