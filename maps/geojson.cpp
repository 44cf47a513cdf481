// RFC 7946, with one word of our own: "crs": "local" for map metres.
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include <talus/maps/gdal_dataset.hpp>
#include <talus/maps/geojson.hpp>
#include <talus/plausible.hpp>
#include <talus/talus.hpp>

namespace talus::maps {
namespace {

using nlohmann::json;

constexpr int kDeepest = 100;  // ten serve all geometries; what walks through a value takes stack for each

std::string typeOf(const json& object) {
  if (!object.is_object()) return "";
  const auto type = object.find("type");
  return type != object.end() && type->is_string() ? type->get<std::string>() : "";
}

void collect(const json& object, std::vector<json>& out) {
  const std::string type = typeOf(object);
  const auto list = [&](const char* key) {
    if (const auto found = object.find(key); found != object.end() && found->is_array())
      for (const json& item : *found) collect(item, out);
  };
  if (type == "FeatureCollection")
    list("features");
  else if (type == "GeometryCollection")
    list("geometries");
  else if (type == "Feature" && object.contains("geometry"))
    collect(object["geometry"], out);
  else if (!type.empty() && object.contains("coordinates"))
    out.push_back(object);
}

// The word stands at the top, as the routes have it, or among a feature's properties.
bool saysLocal(const json& document) {
  const auto is_local = [](const json& object) {
    return object.is_object() && object.contains("crs") && object["crs"] == "local";
  };
  if (is_local(document)) return true;
  if (document.contains("properties") && is_local(document["properties"])) return true;
  const auto features = document.find("features");
  return features != document.end() && features->is_array() && !features->empty() &&
         features->front().is_object() && features->front().contains("properties") &&
         is_local(features->front()["properties"]);
}

}  // namespace

json readGeoJson(const std::string& path) {
  requireReadableFile(path);
  std::ifstream file(path);
  const auto shallow = [&](int depth, json::parse_event_t, const json&) {
    if (depth > kDeepest)
      throw InputError({path, "nests deeper than " + std::to_string(kDeepest) + " levels", "see RFC 7946"});
    return true;
  };
  json document = json::parse(file, shallow, false);
  if (document.is_discarded())
    throw InputError({path, "is not JSON", "check it for a missing bracket or comma"});
  if (typeOf(document).empty())
    throw InputError({path, "is not GeoJSON: it has no \"type\"", "see RFC 7946"});
  return document;
}

std::vector<json> geometries(const json& document) {
  std::vector<json> out;
  collect(document, out);
  return out;
}

PositionReader::PositionReader(const json& document, const ElevationMap& map, std::string path)
    : georeference_(map.georeference && !saysLocal(document) ? &*map.georeference : nullptr),
      path_(std::move(path)) {}

Point PositionReader::operator()(const json& position) const {
  const bool numbers =
      position.is_array() && position.size() >= 2 && position[0].is_number() && position[1].is_number();
  if (!numbers)
    throw InputError({path_, "a position is not an array of numbers", "write [longitude, latitude]"});
  const double x = position[0];
  const double y = position[1];
  if (!plausible(x) || !plausible(y))
    throw InputError({path_, "position " + position.dump() + ": " + kPlausible, "correct the position"});
  if (georeference_ == nullptr) return {x, y};
  if (std::abs(x) > 360 || std::abs(y) > 90)
    throw InputError({path_, "position " + position.dump() + " is not a longitude and latitude",
                      "write degrees, or \"crs\": \"local\" beside \"type\" for map metres"});
  const Point point = georeference_->forward({y * kDegree, x * kDegree});
  if (std::isnan(point.x_m))
    throw InputError({path_, "position " + position.dump() + " is outside the range of the map's CRS", ""});
  return point;
}

}  // namespace talus::maps
