// RFC 7946 with one extension: "crs": "local" for map coordinates in metres.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <cpl_conv.h>
#include <gdal_priv.h>
#include <nlohmann/json.hpp>
#include <ogr_api.h>
#include <ogr_geometry.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>
#include <talus/maps/grid/cover.hpp>
#include <talus/maps/maps.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/raster_frame.hpp>
#include <talus/maps/vector/vector_reader.hpp>

namespace talus::maps {

Point readPlace(const std::string& text, const ElevationMap& map, const std::string& name) {
  const std::string where = name + " " + text;
  if (isNamedAsVector(text) || std::filesystem::exists(text)) return locate(readPoint(text, map), map, where);
  try {
    return locate(parsePlace(text), map, where);
  } catch (const InputError& error) {
    if (error.parts().where == where) throw;
    throw InputError({where, error.parts().reason, error.parts().remedy});
  }
}

namespace {

// Memory of GDAL's geometry, the ring and its edges per byte of a position of 16 bytes.
constexpr double kMemoryPerDrawnByte = 8.0;

/// Rasterises the features of a file one by one. Refuses each feature that would exclude no ground on any
/// map.
class KeepOutReader {
 public:
  KeepOutReader(const std::string& path, const ElevationMap& map)
      : path_(path), keep_out_{.mask = Raster<std::uint8_t>(map.grid())} {}

  void drawFeature(const std::string& name, const OGRGeometry* drawn) {
    begin(name);
    if (drawn == nullptr) refuse("has no geometry", "write its polygon, or remove it");
    requireMemory(kMemoryPerDrawnByte * static_cast<double>(drawn->WkbSize()), path_);
    drawGeometry(*drawn);
  }

  KeepOut drawn(const std::string& map_source) && {
    if (polygons_ == 0) throw InputError({path_, "holds no Polygon", "write the keep-out areas as polygons"});
    if (static_cast<int>(beside_.size()) == polygons_)
      throw InputError({path_, "no polygon overlaps map '" + map_source + "'",
                        "the map " + extent(keep_out_.mask.grid())});
    noteBeside();
    return std::move(keep_out_);
  }

 private:
  [[noreturn]] void refuse(const std::string& reason, const std::string& remedy) const {
    throw InputError({path_, owner_ + reason, remedy});
  }

  void begin(const std::string& name) {
    feature_ =
        "feature " + std::to_string(++features_) + (name.empty() ? "" : " '" + name.substr(0, 40) + "'");
    owner_ = feature_ + ": ";
  }

  [[noreturn]] void refuseType(const std::string& type) const {
    refuse(type.empty() ? "has no geometry" : type.substr(0, 40) + " is no Polygon and keeps nothing out",
           "write it as a Polygon, or remove it");
  }

  void drawGeometry(const OGRGeometry& geometry) {
    switch (wkbFlatten(geometry.getGeometryType())) {
      case wkbPolygon:
      case wkbTriangle:
        return draw(*geometry.toPolygon());
      case wkbMultiPolygon:
      case wkbGeometryCollection:
        for (const OGRGeometry* part : *geometry.toGeometryCollection()) drawGeometry(*part);
        return;
      default:
        refuseType(OGRToOGCGeomType(geometry.getGeometryType()));
    }
  }

  Ring ring(const OGRLinearRing& positions) const {
    if (positions.getNumPoints() < 4)
      refuse("a ring of a polygon has fewer than four positions", "close it on its first position");
    Ring out(static_cast<std::size_t>(positions.getNumPoints()));
    for (int i = 0; i < positions.getNumPoints(); ++i) {
      const Point at{positions.getX(i), positions.getY(i)};
      if (!plausible(at.x_m) || !plausible(at.y_m))
        refuse("position " + std::to_string(i + 1) + " of a ring: " + kPlausible, "correct the position");
      out[static_cast<std::size_t>(i)] = at;
    }
    return out;
  }

  void draw(const OGRPolygon& rings) {
    if (rings.getExteriorRing() == nullptr) refuse("a polygon has no ring", "draw it again");
    Polygon polygon = outside(ring(*rings.getExteriorRing()));
    for (int i = 0; i < rings.getNumInteriorRings(); ++i)
      polygon.holes.push_back(ring(*rings.getInteriorRing(i)));
    draw(polygon);
  }

  Polygon outside(Ring ring) const {
    Polygon polygon{.outer = std::move(ring)};
    if (!enclosesGround(polygon))
      refuse("a polygon encloses no ground",
             "its positions lie in one line or it runs back on itself: correct it");
    return polygon;
  }

  void draw(const Polygon& polygon) {
    if (!polygon.holes.empty() && !enclosesGround(polygon))
      refuse("the holes of a polygon cover all of it", "remove the hole that is as large as its ring");
    ++polygons_;
    if (!cover(polygon, keep_out_.mask)) beside_.push_back(feature_);
  }

  void noteBeside() {
    constexpr std::size_t kNamed = 8;
    if (beside_.empty()) return;
    std::string note = std::to_string(beside_.size()) + " of " + std::to_string(polygons_) +
                       (beside_.size() == 1 ? " polygons lies" : " polygons lie") + " beside the map: ";
    for (std::size_t i = 0; i < beside_.size() && i < kNamed; ++i) note += (i == 0 ? "" : ", ") + beside_[i];
    keep_out_.notes.push_back(note + (beside_.size() > kNamed ? " and others" : ""));
  }

  const std::string& path_;
  KeepOut keep_out_;
  std::string feature_, owner_;
  std::vector<std::string> beside_;
  std::size_t features_ = 0;
  int polygons_ = 0;
};

}  // namespace

KeepOut readKeepOut(const std::string& path, const ElevationMap& map) {
  KeepOutReader reader(path, map);
  visitVector(path, map,
              [&](const std::string& name, const OGRGeometry* drawn) { reader.drawFeature(name, drawn); });
  return std::move(reader).drawn(map.source);
}

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
    throw InputError(
        {path, "contains no line", "a path is a line of a vector file, or CSV with x_m, y_m or lat, lon"});
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

namespace {

using nlohmann::json;

constexpr int kDeepestNesting = 100;  // geometries need ten levels; recursive functions use stack per level

std::string typeOf(const json& object) {
  if (!object.is_object()) return "";
  const auto type = object.find("type");
  return type != object.end() && type->is_string() ? type->get<std::string>() : "";
}

// nlohmann::json needs up to 28 bytes per byte of text ("{},{}"), plus memory for the names in open objects.
constexpr double kMemoryPerByte = 32.0;

const json* memberOf(const json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(name);
  return found == object.end() || found->is_null() ? nullptr : &*found;
}

// "crs" is a member of the document, as in routes, or of the properties of a feature.
bool isLocal(const json& document) {
  const auto is_local = [](const json* object) {
    const json* crs = object == nullptr ? nullptr : memberOf(*object, "crs");
    return crs != nullptr && *crs == "local";
  };
  if (is_local(&document) || is_local(memberOf(document, "properties"))) return true;
  const json* features = memberOf(document, "features");
  return features != nullptr && features->is_array() && !features->empty() &&
         is_local(memberOf(features->front(), "properties"));
}

// Name in a top-level "crs" of GeoJSON before RFC 7946: {"type":"name","properties":{"name":NAME}}.
std::optional<std::string> crsName(const json& document) {
  const json* crs = memberOf(document, "crs");
  if (crs == nullptr) return std::nullopt;
  if (crs->is_string()) return crs->get<std::string>();
  const json* properties = memberOf(*crs, "properties");
  const json* name = properties == nullptr ? nullptr : memberOf(*properties, "name");
  return name != nullptr && name->is_string() ? name->get<std::string>() : crs->dump();
}

// Interprets the name of a CRS. The name is from an untrusted file; file and network access are therefore
// excluded.
OGRSpatialReference systemNamed(const std::string& crs) {
  const GdalErrors errors;
  OGRSpatialReference system;
  if (system.SetFromUserInput(crs.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS) !=
      OGRERR_NONE)
    system.Clear();
  return system;
}

// WGS 84 is accepted on any body, because RFC 7946 defines no other system.
void checkBody(const OGRSpatialReference& system, const std::string& of_map, const std::string& named,
               const std::string& path) {
  const std::string body = bodyName({system.GetSemiMajor(), 0.0});
  if (body != of_map && body != bodyName(kEarth))
    throw InputError(
        {path, named + " of " + body + ", and the map is of " + of_map, "draw it on the map's body"});
}

void checkCrs(const json& document, const std::optional<Georeference>& of_map, const std::string& path) {
  if (isLocal(document)) return;
  const auto crs = crsName(document);
  if (!crs) return;
  const std::string named = "its crs is '" + crs->substr(0, 80) + "'";
  if (!of_map)
    throw InputError({path, named + ", and the map has none", "write map metres and \"crs\": \"local\""});
  const OGRSpatialReference system = systemNamed(*crs);
  if (system.IsGeographic() == 0)
    throw InputError({path, named + ", not longitude and latitude",
                      "transform it, or write map metres and \"crs\": \"local\""});
  checkBody(system, of_map->body(), named, path);
}

// Refuses duplicate members of an object, of which the parser would use the last.
class OnceEach {
 public:
  explicit OnceEach(const std::string& path) : path_(path) {}

  bool operator()(int depth, json::parse_event_t event, const json& value) {
    if (depth > kDeepestNesting)
      throw InputError(
          {path_, "nests deeper than " + std::to_string(kDeepestNesting) + " levels", "see RFC 7946"});
    if (event == json::parse_event_t::object_start) names_.emplace_back();
    if (event == json::parse_event_t::object_end) names_.pop_back();
    if (event == json::parse_event_t::key && !names_.back().insert(value.get<std::string>()).second)
      throw InputError({path_, "has \"" + value.get<std::string>().substr(0, 80) + "\" twice in one object",
                        "remove one"});
    return true;
  }

 private:
  const std::string& path_;
  std::vector<std::set<std::string>> names_;
};

// Makes GDAL's geometries, in map coordinates [m], of those of a document. Every position is checked here, because GDAL
// leaves out parts that it cannot read.
class Geometries {
 public:
  Geometries(const json& document, const ElevationMap& map, const std::string& path)
      : places_(isLocal(document) ? nullptr : map.places()), path_(path) {}

  std::unique_ptr<OGRGeometry> of(json object) const {
    if (object.is_null()) return nullptr;
    place(object);
    std::unique_ptr<OGRGeometry> made(OGRGeometryFactory::createFromGeoJson(object.dump().c_str()));
    if (!made) throw InputError({path_, "has a geometry that GDAL cannot read", "see RFC 7946"});
    return made;
  }

 private:
  // Puts map coordinates in place of the positions of a geometry.
  void place(json& object) const {
    const std::string type = typeOf(object);
    constexpr std::pair<std::string_view, int> kNesting[] = {{"Point", 0},           {"LineString", 1},
                                                             {"MultiPoint", 1},      {"Polygon", 2},
                                                             {"MultiLineString", 2}, {"MultiPolygon", 3}};
    if (type == "GeometryCollection") {
      for (json& part : list(object["geometries"])) place(part);
      return;
    }
    for (const auto& [name, depth] : kNesting)
      if (type == name) return place(list(object["coordinates"]), depth);
    throw InputError(
        {path_,
         type.empty() ? "has a geometry without a \"type\"" : "'" + type.substr(0, 40) + "' is no geometry",
         "see RFC 7946"});
  }

  void place(json& positions, int depth) const {
    if (depth > 0) {
      for (json& one : list(positions)) place(one, depth - 1);
    } else {
      const Point p = at(positions);
      positions = {p.x_m, p.y_m};
    }
  }

  json& list(json& found) const {
    if (!found.is_array())
      throw InputError({path_, "a geometry has no list of its positions", "see RFC 7946"});
    return found;
  }

  Point at(const json& position) const {
    const bool numbers =
        position.is_array() && position.size() >= 2 && position[0].is_number() && position[1].is_number();
    if (!numbers)
      throw InputError({path_, "a position is not an array of numbers", "write [longitude, latitude]"});
    const double x = position[0];
    const double y = position[1];
    if (!plausible(x) || !plausible(y))
      throw InputError({path_, "position " + position.dump() + ": " + kPlausible, "correct the position"});
    if (places_ == nullptr) return {x, y};
    if (std::abs(x) > 360 || std::abs(y) > 90)
      throw InputError({path_, "position " + position.dump() + " is not a longitude and latitude",
                        "write degrees, or \"crs\": \"local\" beside \"type\" for map metres"});
    const Point point = places_->forward({y * kDegree, x * kDegree});
    if (std::isnan(point.x_m))
      throw InputError({path_, "position " + position.dump() + " is outside the range of the map's CRS", ""});
    return point;
  }

  const Georeference* places_;  // null: positions are map coordinates
  const std::string& path_;
};

}  // namespace

json readGeoJson(const std::string& path) {
  requireReadableFile(path);
  requireMemory(kMemoryPerByte * static_cast<double>(std::filesystem::file_size(path)), path);
  std::ifstream file(path);
  OnceEach check(path);
  json document = json::parse(file, std::ref(check), false);
  if (document.is_discarded())
    throw InputError({path, "is not JSON", "check it for a missing bracket or comma"});
  if (typeOf(document).empty())
    throw InputError({path, "is not GeoJSON: it has no \"type\"", "see RFC 7946"});
  return document;
}

bool namesProjectedCrs(const json& document) {
  const auto crs = isLocal(document) ? std::nullopt : crsName(document);
  return crs && systemNamed(*crs).IsProjected() != 0;
}

void visitGeoJson(const json& document, const ElevationMap& map, const std::string& path,
                  const FeatureVisitor& visit) {
  const GdalErrors quiet;  // of rings that are not closed
  checkCrs(document, map.georeference, path);
  const Geometries geometries(document, map, path);
  const auto one = [&](const json& object) {
    if (typeOf(object) != "Feature") return visit("", geometries.of(object).get());
    const json *properties = memberOf(object, "properties"), *drawn = memberOf(object, "geometry");
    const json* name = properties == nullptr ? nullptr : memberOf(*properties, "name");
    visit(name != nullptr && name->is_string() ? name->get<std::string>() : "",
          drawn == nullptr ? nullptr : geometries.of(*drawn).get());
  };
  if (typeOf(document) != "FeatureCollection") return one(document);
  const json* features = memberOf(document, "features");
  if (features == nullptr || !features->is_array())
    throw InputError({path, "has no list \"features\"", "see RFC 7946"});
  for (const json& feature : *features) one(feature);
}

}  // namespace talus::maps
