#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/draw/colour.hpp>
#include <talus/cli/route/route_writer.hpp>
#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/maps/vector/vector_writer.hpp>
#include <talus/terramech/io/csv_reader.hpp>

namespace talus::cli {
namespace {

using Json = nlohmann::ordered_json;

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
    const Colour c = colourOf(one);
    categories += fmt::format("<category value=\"{0}\" label=\"{0}\" symbol=\"{1}\" render=\"true\"/>\n",
                              terramech::name(one), static_cast<int>(one));
    symbols += fmt::format(
        "<symbol name=\"{}\" type=\"{}\" alpha=\"1\">{}{}</symbol>\n", static_cast<int>(one),
        points ? "marker" : "line", points ? "" : layer(0, "34,34,34,255", "1.5"),
        layer(1, fmt::format("{:.0f},{:.0f},{:.0f},255", 255 * c.red, 255 * c.green, 255 * c.blue),
              points ? "1.2" : "0.9"));
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
    if (isNamed(path, ending)) return driver;
  return "";
}

// Warns if GeoJSON, which other programs take for WGS 84 of Earth, cannot state the frame of the map.
void warnOfFrame(const std::string& path, const maps::ElevationMap& map, const Context& context) {
  const std::string body = map.places() != nullptr ? map.georeference->body() : "";
  const std::string package = std::filesystem::path(path).replace_extension(".gpkg").string();
  if (map.places() == nullptr)
    context.warn(fmt::format(
        "{}: the map has no CRS, and other programs take its metres for degrees of WGS 84; write {}, or give "
        "the map a CRS",
        path, package));
  else if (!body.empty() && body != maps::bodyName(maps::kEarth))
    context.warn(fmt::format(
        "{}: GeoJSON does not say that its longitudes and latitudes are of {}; other programs take them "
        "for WGS 84 of Earth, but not those of a GeoPackage ({})",
        path, body, package));
}

}  // namespace

void requireRouteFormat(const std::string& path, const maps::ElevationMap& map) {
  if (const std::string driver = driverOf(path); !driver.empty()) maps::requireWritable(driver, map, path);
}

void writeRoute(const std::string& path, const Json& route, const maps::ElevationMap& map,
                const Context& context) {
  const Json& properties = route["features"][0]["properties"];
  const std::vector<Json> vertices = verticesOf(properties);
  if (isNamed(path, ".csv")) return writeFile(path, csvOf(vertices, map));
  const std::string driver = driverOf(path);
  if (driver.empty()) {
    warnOfFrame(path, map, context);
    return writeFile(path, jsonText(route) + "\n");
  }
  std::vector<maps::VectorLayer> layers{wholeLayer(properties, vertices)};
  if (driver != "GPX") layers.push_back(vertexLayer(vertices));
  if (driver == "GPKG") {
    layers.push_back(segmentLayer(vertices));
    layers.push_back(styleLayer());
  }
  writeFile(path, maps::vectorFile(driver, map, layers, path, driver == "GPKG" ? route.dump() : ""));
}

}  // namespace talus::cli
