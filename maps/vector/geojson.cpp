// RFC 7946 with one extension: "crs": "local" for map coordinates in metres.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <vector>

#include <nlohmann/json.hpp>
#include <ogr_geometry.h>
#include <ogr_spatialref.h>

#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/common/memory_budget.hpp>
#include <talus/common/plausible.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/vector/geojson.hpp>

namespace talus::maps {
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

// Makes GDAL's geometries, in map coordinates [m], of those of a document.
class Geometries {
 public:
  Geometries(const json& document, const ElevationMap& map, const std::string& path)
      : places_(isLocal(document) ? nullptr : map.places()), path_(path) {}

  std::unique_ptr<OGRGeometry> of(const json& object) const {
    const std::string type = typeOf(object);
    if (type == "GeometryCollection")
      return parts<OGRGeometryCollection>(object, "geometries", &Geometries::of);
    if (type == "MultiPolygon") return parts<OGRMultiPolygon>(object, "coordinates", &Geometries::polygon);
    if (type == "MultiLineString") return parts<OGRMultiLineString>(object, "coordinates", &Geometries::line);
    if (type == "MultiPoint") return parts<OGRMultiPoint>(object, "coordinates", &Geometries::point);
    const json* at = memberOf(object, "coordinates");
    if (type == "Polygon") return polygon(list(at));
    if (type == "LineString") return line(list(at));
    if (type == "Point") return point(list(at));
    if (object.is_null()) return nullptr;
    throw InputError(
        {path_,
         type.empty() ? "has a geometry without a \"type\"" : "'" + type.substr(0, 40) + "' is no geometry",
         "see RFC 7946"});
  }

 private:
  const json& list(const json* found) const {
    if (found == nullptr || !found->is_array())
      throw InputError({path_, "a geometry has no list of its positions", "see RFC 7946"});
    return *found;
  }

  template <class Whole, class Part>
  std::unique_ptr<OGRGeometry> parts(const json& object, const char* name, Part part) const {
    auto whole = std::make_unique<Whole>();
    for (const json& one : list(memberOf(object, name)))
      if (auto made = (this->*part)(one)) whole->addGeometryDirectly(made.release());
    return whole;
  }

  std::unique_ptr<OGRGeometry> point(const json& position) const {
    const Point p = at(position);
    return std::make_unique<OGRPoint>(p.x_m, p.y_m);
  }
  std::unique_ptr<OGRGeometry> line(const json& positions) const {
    auto made = std::make_unique<OGRLineString>();
    fill(list(&positions), *made);
    return made;
  }
  std::unique_ptr<OGRGeometry> polygon(const json& rings) const {
    auto made = std::make_unique<OGRPolygon>();
    for (const json& positions : list(&rings)) {
      auto ring = std::make_unique<OGRLinearRing>();
      fill(list(&positions), *ring);
      made->addRingDirectly(ring.release());
    }
    return made;
  }
  void fill(const json& positions, OGRSimpleCurve& curve) const {
    curve.setNumPoints(static_cast<int>(positions.size()));
    int i = 0;
    for (const json& position : positions) {
      const Point p = at(position);
      curve.setPoint(i++, p.x_m, p.y_m);
    }
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
