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
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/spatial_reference.hpp>
#include <talus/maps/vector/geojson.hpp>
#include <talus/maps/vector/vector_reader.hpp>

namespace talus::maps {
namespace {

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

// The points and lines of a geometry, in order.
void gather(const OGRGeometry& drawn, std::vector<const OGRGeometry*>& found) {
  const OGRwkbGeometryType type = wkbFlatten(drawn.getGeometryType());
  if (type == wkbMultiPoint || type == wkbGeometryCollection)
    for (const OGRGeometry* part : *drawn.toGeometryCollection()) gather(*part, found);
  else
    found.push_back(&drawn);
}

}  // namespace

void visitVector(const std::string& path, const ElevationMap& map, const FeatureVisitor& visit) {
  requireReadableFile(path);
  if (beginsAsJson(path))
    if (const nlohmann::json document = readGeoJson(path); !map.georeference || !namesProjectedCrs(document))
      return visitGeoJson(document, map, path, visit);
  const Dataset file = openVector(path);
  FeatureReader reader(map, path, visit);
  for (OGRLayer* layer : file->GetLayers())
    if (!isCopy(layer->GetName())) reader.read(*layer);
  if (reader.features() == 0)
    throw InputError({path, "contains no feature", "draw the places, lines or areas in it"});
}

Point readPoint(const std::string& path, const ElevationMap& map) {
  std::optional<Point> first;
  visitVector(path, map, [&](const std::string&, const OGRGeometry* drawn) {
    std::vector<const OGRGeometry*> parts;
    if (drawn != nullptr && !first) gather(*drawn, parts);
    for (const OGRGeometry* part : parts)
      if (wkbFlatten(part->getGeometryType()) == wkbPoint && !first)
        first = {part->toPoint()->getX(), part->toPoint()->getY()};
  });
  if (!first) throw InputError({path, "holds no Point", "draw a point feature"});
  return *first;
}

std::vector<Point> readLine(const std::string& path, const ElevationMap& map) {
  std::vector<Point> points;
  visitVector(path, map, [&](const std::string&, const OGRGeometry* drawn) {
    std::vector<const OGRGeometry*> parts;
    if (drawn != nullptr && points.empty()) gather(*drawn, parts);
    for (const OGRGeometry* part : parts) {
      if (!points.empty()) return;
      if (wkbFlatten(part->getGeometryType()) == wkbMultiLineString) {
        const OGRMultiLineString& lines = *part->toMultiLineString();
        if (lines.getNumGeometries() != 1)
          throw InputError({path, "contains a line of " + std::to_string(lines.getNumGeometries()) + " parts",
                            "join them to one"});
        part = lines.getGeometryRef(0);
      }
      if (wkbFlatten(part->getGeometryType()) != wkbLineString) continue;
      const OGRLineString& line = *part->toLineString();
      requireFewPositions(static_cast<std::size_t>(line.getNumPoints()), path);
      for (int i = 0; i < line.getNumPoints(); ++i) points.push_back({line.getX(i), line.getY(i)});
    }
  });
  if (points.empty())
    throw InputError({path, "contains no line", "a path is a line of a vector file, or CSV with x_m, y_m"});
  return points;
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
