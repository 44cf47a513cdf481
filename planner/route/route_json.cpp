#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/common/common.hpp>
#include <talus/common/output_file.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/vector/vector_writer.hpp>
#include <talus/planner/route/route_json.hpp>
#include <talus/terramech/io/csv_reader.hpp>

namespace talus::planner {
namespace {

using Json = nlohmann::ordered_json;
using Warn = std::function<void(std::string_view)>;

Json position(const RouteVertex& vertex, const maps::ElevationMap& map) {
  Json made = Json::array();
  if (const maps::Georeference* places = map.places()) {
    const maps::GeoPoint place = places->reverse({vertex.x_m, vertex.y_m});
    made = {place.longitude_rad / kDegree, place.latitude_rad / kDegree};
  } else {
    made = {vertex.x_m, vertex.y_m};
  }
  if (std::isfinite(vertex.elevation_m)) made.push_back(vertex.elevation_m);
  return made;
}

template <typename Value>
Json values(const Route& route, Value value) {
  Json made = Json::array();
  for (const RouteVertex& vertex : route.vertices) made.push_back(value(vertex));
  return made;
}

void addVertices(Json& properties, const Route& route) {
  const auto add = [&](const char* key, double RouteVertex::*field) {
    properties[key] = values(route, [field](const RouteVertex& vertex) { return vertex.*field; });
  };
  for (const auto& [column, field] : kVertexColumns) {
    // The totals are in "summary", to avoid confusion with these arrays.
    if (field == &RouteVertex::energy_J)
      properties["category"] =
          values(route, [](const RouteVertex& vertex) { return terramech::name(vertex.category); });
    add(column, field);
  }
  if (!route.drive) return;
  add("curvature_1_m", &RouteVertex::curvature_1_m);
  add("turn_rad", &RouteVertex::turn_rad);
  properties["reverse"] = values(route, [](const RouteVertex& vertex) { return vertex.reverse; });
}

Json obstructionJson(const Obstruction& why) {
  const auto place = [](maps::Point p) { return Json{{"x_m", p.x_m}, {"y_m", p.y_m}}; };
  Json made{{"cells_from_start", why.cells_from_start},
            {"cells_to_goal", why.cells_to_goal},
            {"last", place(why.last)},
            {"first", place(why.first)}};
  made["lifting"] = why.lifting ? Json(name(*why.lifting)) : Json(nullptr);
  if (why.hazard) made["hazard"] = name(*why.hazard);
  if (why.also) made["also"] = name(*why.also);
  return made;
}

// The number, or NaN if the value is not a number.
double numberIn(const Json& value) {
  return value.is_number() ? value.get<double>() : kNaN;
}

maps::VectorPosition positionOf(const Json& vertex) {
  return {{vertex["x_m"], vertex["y_m"]}, numberIn(vertex["elevation_m"])};
}

// Converts the lists of a route to one object per vertex.
std::vector<Json> verticesOf(const Json& properties) {
  std::vector<Json> vertices(properties["x_m"].size(), {{"x_m", 0.0}, {"y_m", 0.0}});  // fixes the order of
                                                                                       // columns
  for (const auto& [name, values] : properties.items())
    if (values.is_array() && values.size() == vertices.size())
      for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i][name] = values[i];
  return vertices;
}

maps::VectorLayer wholeLayer(const Json& properties, const std::vector<Json>& vertices) {
  maps::VectorFeature whole;
  for (const Json& vertex : vertices) whole.positions.push_back(positionOf(vertex));
  if (vertices.size() == 1) whole.positions.push_back(whole.positions.front());  // a line needs two positions
  whole.fields = {{"name", "route"}};
  for (const auto& [name, value] : properties["summary"].items())
    if (value.is_primitive()) whole.fields[name] = value;
  for (const char* name : {"seed", "version"}) whole.fields[name] = properties[name];
  whole.fields["inputs"] = properties["inputs"].dump();
  whole.fields["desc"] =
      fmt::format("{:.0f} m, {:.0f} s, {:.0f} J", numberIn(properties["length_m"]),
                  numberIn(properties["summary"]["time_s"]), numberIn(properties["summary"]["energy_J"]));
  return {"route", {std::move(whole)}};
}

maps::VectorLayer vertexLayer(const std::vector<Json>& vertices) {
  maps::VectorLayer layer{"vertices", {}};
  for (const Json& vertex : vertices) layer.features.push_back({{positionOf(vertex)}, vertex});
  return layer;
}

// Segments between consecutive vertices, with the properties of the motion and its shares of energy, time and
// risk.
maps::VectorLayer segmentLayer(const std::vector<Json>& vertices) {
  maps::VectorLayer layer{"segments", {}};
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
    const Json &from = vertices[i], &to = vertices[i + 1];
    Json fields = from;
    fields.erase("x_m");
    fields.erase("y_m");
    for (const char* total : {"energy_J", "time_s"})
      fields[total] = numberIn(to[total]) - numberIn(from[total]);
    const double risk = numberIn(from["immobilisation_risk"]);
    fields["immobilisation_risk"] =
        risk < 1.0 ? (numberIn(to["immobilisation_risk"]) - risk) / (1.0 - risk) : 0.0;
    fields["length_m"] =
        std::hypot(numberIn(to["x_m"]) - numberIn(from["x_m"]), numberIn(to["y_m"]) - numberIn(from["y_m"]));
    layer.features.push_back({{positionOf(from), positionOf(to)}, std::move(fields)});
  }
  return layer;
}

// QGIS style that colours the features of a layer by their category: segments as lines with a dark rim, vertices
// as points.
std::string categoryQml(bool points) {
  using terramech::Category;
  const auto layer = [points](int pass, const std::string& colour, const char* width) {
    return fmt::format(
        "<layer class=\"{}\" enabled=\"1\" pass=\"{}\"><prop k=\"{}\" v=\"{}\"/><prop k=\"{}\" "
        "v=\"{}\"/></layer>",
        points ? "SimpleMarker" : "SimpleLine", pass, points ? "color" : "line_color", colour,
        points ? "size" : "line_width", width);
  };
  std::string categories, symbols;
  for (const Category one : {Category::Safe, Category::Marginal, Category::Dangerous, Category::Unknown}) {
    const unsigned c = categoryColour(one);
    categories += fmt::format("<category value=\"{0}\" label=\"{0}\" symbol=\"{1}\" render=\"true\"/>\n",
                              terramech::name(one), static_cast<int>(one));
    symbols += fmt::format(
        "<symbol name=\"{}\" type=\"{}\" alpha=\"1\">{}{}</symbol>\n", static_cast<int>(one),
        points ? "marker" : "line", points ? "" : layer(0, "34,34,34,255", "1.5"),
        layer(1, fmt::format("{},{},{},255", c >> 16, c >> 8 & 255, c & 255), points ? "1.2" : "0.9"));
  }
  return "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n<qgis version=\"3.22\">\n<renderer-v2 "
         "type=\"categorizedSymbol\" attr=\"category\" symbollevels=\"1\">\n<categories>\n" +
         categories + "</categories>\n<symbols>\n" + symbols + "</symbols>\n</renderer-v2>\n</qgis>\n";
}

// The table from which QGIS reads the default styles of the layers of a GeoPackage.
maps::VectorLayer styleLayer() {
  maps::VectorLayer layer{"layer_styles", {}};
  for (const char* of : {"vertices", "segments"})
    layer.features.push_back({{},
                              {{"f_table_catalog", ""},
                               {"f_table_schema", ""},
                               {"f_table_name", of},
                               {"f_geometry_column", "geom"},
                               {"styleName", "category"},
                               {"styleQML", categoryQml(of[0] == 'v')},
                               {"styleSLD", ""},
                               {"useAsDefault", true},
                               {"description", "traversability category"},
                               {"owner", ""},
                               {"ui", ""},
                               {"update_time", "1970-01-01T00:00:00.000Z"}}});
  return layer;
}

std::string csvOf(const std::vector<Json>& vertices, const maps::ElevationMap& map) {
  std::string text;
  for (const auto& [name, value] : vertices.front().items()) text += name + ",";
  const maps::Georeference* places = map.places();
  text += places != nullptr ? "latitude_deg,longitude_deg\n" : "\n";
  for (const Json& vertex : vertices) {
    for (const auto& [name, value] : vertex.items())
      text += (value.is_string() ? terramech::csvField(value.get<std::string>())
               : value.is_null() ? ""
               : std::isnan(value.is_number() ? value.get<double>() : 0.0) ? ""
                                                                           : value.dump()) +
              ",";
    if (places != nullptr) {
      const maps::GeoPoint at = places->reverse(positionOf(vertex).at);
      text += Json(at.latitude_rad / kDegree).dump() + "," + Json(at.longitude_rad / kDegree).dump() + ",";
    }
    text.back() = '\n';
  }
  if (places == nullptr) text.erase(text.find('\n') - 1, 1);
  return text;
}

// GDAL driver for the ending of a name; empty for GeoJSON and CSV.
std::string driverOf(const std::string& path) {
  for (const auto& [ending, driver] : {std::pair{".gpkg", "GPKG"}, {".gpx", "GPX"}, {".kml", "KML"}})
    if (maps::lower(path).ends_with(ending)) return driver;
  return "";
}

// Warns if GeoJSON, which other programs take for WGS 84 of Earth, cannot state the frame of the map.
void warnOfFrame(const std::string& path, const maps::ElevationMap& map, const Warn& warn) {
  const std::string body = map.places() != nullptr ? map.georeference->body() : "";
  const std::string package = std::filesystem::path(path).replace_extension(".gpkg").string();
  if (map.places() == nullptr)
    warn(fmt::format(
        "{}: the map has no CRS, and other programs take its metres for degrees of WGS 84; write {}, or give "
        "the map a CRS",
        path, package));
  else if (!body.empty() && body != maps::bodyName(maps::kEarth))
    warn(fmt::format(
        "{}: GeoJSON does not say that its longitudes and latitudes are of {}; other programs take them "
        "for WGS 84 of Earth, but not those of a GeoPackage ({})",
        path, body, package));
}

}  // namespace

unsigned categoryColour(terramech::Category category) noexcept {
  switch (category) {
    case terramech::Category::Safe:
      return 0xF2FFF8;
    case terramech::Category::Marginal:
      return 0xE58E10;
    case terramech::Category::Dangerous:
      return 0x9E1020;
    case terramech::Category::Unknown:
      break;
  }
  return 0x000000;
}

RouteOrigin originOf(const costmap::TraversabilityMap& map, std::vector<InputFile> files,
                     std::uint64_t seed) {
  RouteOrigin origin{.files = std::move(files),
                     .seed = seed,
                     .rover = map.model().rover().name,
                     .reading = map.elevation().reading};
  for (const costmap::GroundClass& one : map.model().parts().classes) origin.soils.push_back(one.soil.name);
  return origin;
}

Json originJson(const RouteOrigin& origin) {
  Json files = Json::array();
  for (const InputFile& input : origin.files) {
    const std::string name = std::filesystem::path(input.path).filename();
    files.push_back({{"file", name}, {"path", input.path}, {"sha256", input.sha256}, {"size", input.size}});
    if (!input.role.empty()) files.back()["role"] = input.role;
    if (!input.used) files.back()["used"] = false;
  }
  Json made{{"files", files}, {"seed", origin.seed}, {"version", TALUS_VERSION}};
  if (!origin.rover.empty()) made["rover"] = origin.rover;
  if (!origin.soils.empty()) made["soils"] = origin.soils;
  if (!origin.reading.empty()) made["reading"] = origin.reading;
  if (!origin.command.empty()) made["command"] = origin.command;
  return made;
}

Json summaryJson(const Route& route) {
  const RouteSummary& s = route;
  Json made;
  made["status"] = std::string(name(route.status));
  const bool none = route.vertices.empty();
  for (const auto& [key, value] : kSummaryColumns) made[key] = none ? Json() : Json(s.*value);
  made["immobilisation_risk"] = none ? Json() : Json(route.vertices.back().immobilisation_risk);
  if (none) {
    made["planner"] = s.planner;
    if (route.obstruction) made["obstruction"] = obstructionJson(*route.obstruction);
    return made;
  }
  made["planner"] = s.planner;
  if (route.interrupted) made["interrupted"] = true;
  if (s.drive)
    made["drive"] = {{"cusps", s.drive->cusps},
                     {"turns_in_place", s.drive->turns_in_place},
                     {"turned_rad", s.drive->turned_rad},
                     {"max_curvature_1_m", s.drive->max_curvature_1_m}};
  return made;
}

Json routeGeoJson(const Route& route, const maps::ElevationMap& map, const RouteOrigin& origin) {
  Json line = values(route, [&map](const RouteVertex& vertex) { return position(vertex, map); });
  if (line.size() == 1) line.push_back(line.front());
  const Json summary = summaryJson(route);
  Json properties = summary;
  properties["summary"] = summary;
  addVertices(properties, route);
  properties["inputs"] = originJson(origin);
  properties["seed"] = origin.seed;
  properties["version"] = TALUS_VERSION;
  if (map.places() == nullptr) properties["crs"] = "local";
  Json feature;
  feature["type"] = "Feature";
  feature["geometry"] = {{"type", "LineString"}, {"coordinates", line}};
  feature["properties"] = properties;
  Json made;
  made["type"] = "FeatureCollection";
  if (map.places() == nullptr) made["crs"] = "local";
  made["features"] = Json::array({feature});
  return made;
}

void requireRouteFormat(const std::string& path, const maps::ElevationMap& map) {
  if (const std::string driver = driverOf(path); !driver.empty()) maps::requireWritable(driver, map, path);
}

void writeRoute(const std::string& path, const Json& route, const maps::ElevationMap& map, const Warn& warn) {
  const Json& properties = route["features"][0]["properties"];
  const std::vector<Json> vertices = verticesOf(properties);
  if (maps::lower(path).ends_with(".csv")) return writeFile(path, csvOf(vertices, map));
  const std::string driver = driverOf(path);
  if (driver.empty()) {
    warnOfFrame(path, map, warn);
    return writeFile(path, route.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
  }
  std::vector<maps::VectorLayer> layers{wholeLayer(properties, vertices)};
  if (driver != "GPX") layers.push_back(vertexLayer(vertices));
  if (driver == "GPKG") {
    layers.push_back(segmentLayer(vertices));
    layers.push_back(styleLayer());
  }
  writeFile(path, maps::vectorFile(driver, map, layers, path, driver == "GPKG" ? route.dump() : ""));
}

}  // namespace talus::planner
