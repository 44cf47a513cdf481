#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/draw/canvas.hpp>
#include <talus/cli/draw/scene.hpp>
#include <talus/cli/ground/ground_options.hpp>
#include <talus/cli/route/route_reader.hpp>
#include <talus/common/common.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/vector/vector_writer.hpp>

namespace talus::cli {

namespace {

using nlohmann::ordered_json;

std::string textOf(const ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.is_null() ? "" : value.dump();
  return listText(value, textOf);
}

}  // namespace

std::string callText(const char* const* argv) {
  static const std::set<std::string_view> flags{"--json", "--quiet", "--force"};
  static const std::set<std::string_view> with_values{"-o",        "--output",    "--html", "--png",
                                                      "--threads", "--telemetry", "--part"};
  if (argv == nullptr || *argv == nullptr) return "";
  std::string text = "talus";
  for (const char* const* word = argv + 1; *word != nullptr; ++word) {
    const std::string_view whole = *word;
    const std::string_view name = whole.substr(0, whole.find('='));
    if (flags.contains(whole)) continue;
    if (with_values.contains(name)) {
      if (name == whole && word[1] != nullptr) ++word;
      continue;
    }
    text += " " + shellWord(std::string(whole));
  }
  return text;
}

std::vector<std::pair<std::string, std::string>> provenanceOf(const ordered_json& inputs) {
  std::vector<std::pair<std::string, std::string>> facts;
  if (!inputs.is_object()) return facts;
  for (const auto& [key, label] : {std::pair{"command", "command"},
                                   {"rover", "rover"},
                                   {"soils", "soil"},
                                   {"seed", "seed"},
                                   {"reading", "map read"},
                                   {"version", "version"}})
    if (inputs.contains(key)) facts.emplace_back(label, textOf(inputs.at(key)));
  if (inputs.contains("files") && inputs.at("files").is_array())
    for (const ordered_json& file : inputs.at("files"))
      if (file.is_object() && file.contains("file") && file.contains("sha256"))
        facts.emplace_back("SHA-256", textOf(file.at("file")) + " " + textOf(file.at("sha256")));
  return facts;
}

planner::RouteOrigin originOf(const Ground& ground, const Context& context) {
  planner::RouteOrigin origin = planner::originOf(ground.map, ground.files, context.seed);
  origin.command = callText(context.argv);
  return origin;
}

void addProvenance(Scene& scene, const planner::RouteOrigin& origin) {
  scene.provenance = provenanceOf(planner::originJson(origin));
  std::erase_if(scene.facts, [](const Fact& fact) { return fact.first == "rover" || fact.first == "soil"; });
}

namespace {

bool isGeoPackage(const std::string& path) {
  return maps::lower(path).ends_with(".gpkg");
}

using nlohmann::json;
using planner::RouteVertex;

constexpr const char* kRemedy = "pass a route from `talus plan -o`";

/// Fields of a JSON object; errors name file and field.
class Fields {
 public:
  Fields(std::string path, const json& object) : path_(std::move(path)), object_(object) {
    if (!object.is_object()) refuse("properties", "is missing");
  }

  /// Null is read as NaN.
  double number(const char* field) const { return numberOf(field, at(field)); }

  int count(const char* field) const {
    const double value = number(field);
    if (!(value >= 0.0 && value <= 1e9)) refuse(field, "is no count");
    return static_cast<int>(value);
  }

  std::string text(const char* field) const {
    const json& value = at(field);
    if (!value.is_string()) refuse(field, "is not a text");
    return value.get<std::string>();
  }

  const json& array(const char* field) const {
    const json& value = at(field);
    if (!value.is_array()) refuse(field, "is not an array");
    return value;
  }

  bool has(const char* field) const { return object_.contains(field); }

  /// Reads one value per vertex; null is read as NaN.
  void fill(const char* field, double RouteVertex::*member, std::vector<RouteVertex>& vertices) const {
    const json& values = array(field);
    if (values.size() != vertices.size())
      refuse(field, fmt::format("has {} values for {} vertices", values.size(), vertices.size()));
    for (std::size_t i = 0; i < values.size(); ++i) vertices[i].*member = numberOf(field, values[i]);
  }

  [[noreturn]] void refuse(const char* field, const std::string& what) const {
    throw InputError({path_, fmt::format("'{}' {}", field, what), kRemedy});
  }

 private:
  double numberOf(const char* field, const json& value) const {
    constexpr double kMost = 1e30;  // greater than any cost under the largest weights
    if (value.is_null()) return std::nan("");
    if (!value.is_number()) refuse(field, "holds what is no number");
    if (!(std::abs(value.get<double>()) <= kMost)) refuse(field, "holds a number beyond 1e30");
    return value.get<double>();
  }

  const json& at(const char* field) const {
    const auto found = object_.find(field);
    if (found == object_.end()) refuse(field, "is missing");
    return *found;
  }

  std::string path_;
  const json& object_;
};

// The document stored in a GeoPackage, with the coordinates of its line layer.
json fromGeoPackage(const std::string& path) {
  const maps::StoredDocument stored = maps::storedDocument(path);
  json document = json::parse(stored.document, nullptr, false);
  const auto place = json::json_pointer("/features/0/geometry/coordinates");
  if (document.is_discarded() || !document.contains(place))
    throw InputError({path, "contains no route", kRemedy});
  json& line = document[place] = json::array();
  for (const maps::Point& point : stored.line) line.push_back({point.x_m, point.y_m});
  document["crs"] = "local";
  return document;
}

json parsed(const std::string& path) {
  if (isGeoPackage(path)) return fromGeoPackage(path);
  maps::requireReadableFile(path);
  std::ifstream stream(path, std::ios::binary);
  json document = json::parse(stream, nullptr, false);
  if (document.is_discarded()) throw InputError({path, "is not valid JSON", kRemedy});
  return document;
}

terramech::Category categoryOf(const Fields& fields, const json& word) {
  using terramech::Category;
  for (const Category c : {Category::Safe, Category::Marginal, Category::Dangerous, Category::Unknown})
    if (word == terramech::name(c)) return c;
  fields.refuse("category", "contains an unknown word");
}

void readVertices(const Fields& fields, std::vector<RouteVertex>& vertices) {
  vertices.resize(fields.array("x_m").size());
  if (vertices.empty()) fields.refuse("x_m", "is empty");
  fields.fill("x_m", &RouteVertex::x_m, vertices);
  fields.fill("y_m", &RouteVertex::y_m, vertices);
  for (const RouteVertex& v : vertices)
    if (!std::isfinite(v.x_m) || !std::isfinite(v.y_m))
      fields.refuse("x_m, y_m", "contain values that are not numbers");
  for (const auto& [column, member] : planner::kVertexColumns) {
    // absent in routes of version 0.1.0
    const bool later = member == &RouteVertex::slip_angle_rad ||
                       member == &RouteVertex::side_force_over_load ||
                       member == &RouteVertex::stability_margin_rad;
    if (!later || fields.has(column)) fields.fill(column, member, vertices);
  }
  const json& categories = fields.array("category");
  if (categories.size() != vertices.size()) fields.refuse("category", "differs in length from x_m");
  for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i].category = categoryOf(fields, categories[i]);
}

// Refuses an edited line, because the page would draw the original x_m and y_m. Coordinates in degrees are
// compared when the map is known (readPath()).
void requireLine(const Fields& fields, const json& document, const std::vector<RouteVertex>& vertices) {
  const auto place = json::json_pointer("/features/0/geometry/coordinates");
  const json line = document.contains(place) ? document.at(place) : json();
  const bool stands = vertices.size() == 1 && line.size() == 2;  // a line needs two positions
  if (!line.is_array() || (line.size() != vertices.size() && !stands))
    fields.refuse("coordinates", fmt::format("are not the {} of x_m and y_m", vertices.size()));
  if (document.value("crs", json()) != "local") return;
  double length_m = 0.0;
  for (std::size_t i = 1; i < vertices.size(); ++i)
    length_m += std::hypot(vertices[i].x_m - vertices[i - 1].x_m, vertices[i].y_m - vertices[i - 1].y_m);
  const double rounding_m = 0.1 * length_m / static_cast<double>(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const json& at = line[i];
    const bool numbers = at.is_array() && at.size() >= 2 && at[0].is_number() && at[1].is_number();
    if (!numbers || !(std::hypot(at[0].get<double>() - vertices[i].x_m,
                                 at[1].get<double>() - vertices[i].y_m) <= rounding_m))
      fields.refuse("coordinates",
                    fmt::format("are not x_m and y_m at vertex {}: the line was edited", i + 1));
  }
}

// Reads the fields that only drives have.
void readDrive(const Fields& fields, std::vector<RouteVertex>& vertices) {
  fields.fill("curvature_1_m", &RouteVertex::curvature_1_m, vertices);
  fields.fill("turn_rad", &RouteVertex::turn_rad, vertices);
  const json& reverse = fields.array("reverse");
  if (reverse.size() != vertices.size()) fields.refuse("reverse", "differs in length from x_m");
  for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i].reverse = reverse[i] == json(true);
}

planner::RouteShape shapeFrom(const Fields& drive) {
  return {.cusps = drive.count("cusps"),
          .turns_in_place = drive.count("turns_in_place"),
          .turned_rad = drive.number("turned_rad"),
          .max_curvature_1_m = drive.number("max_curvature_1_m")};
}

planner::RouteSummary summaryFrom(const Fields& fields) {
  planner::RouteSummary summary{.planner = fields.text("planner")};
  for (const auto& [key, value] : planner::kSummaryColumns) {
    // absent in routes of older versions
    const bool later = std::string_view(key).find("p90") != std::string_view::npos ||
                       value == &planner::RouteSummary::max_slope_across_rad ||
                       value == &planner::RouteSummary::max_slip_angle_rad;
    summary.*value = later && !fields.has(key) ? std::nan("") : fields.number(key);
  }
  return summary;
}

/// A member of an object; null if the object or the member is missing.
json member(const json& object, const char* key) {
  return object.is_object() && object.contains(key) ? object.at(key) : json();
}

std::vector<InputFile> inputsOf(const json& properties) {
  std::vector<InputFile> inputs;
  for (const json& file : member(member(properties, "inputs"), "files")) {
    const auto text = [&](const char* key) {
      const json value = member(file, key);
      return value.is_string() ? value.get<std::string>() : "";
    };
    if (text("file").empty() || text("sha256").empty()) continue;
    inputs.push_back({.path = text("path").empty() ? text("file") : text("path"),
                      .role = text("role"),
                      .sha256 = text("sha256")});
  }
  return inputs;
}

}  // namespace

bool looksLikeRoute(const std::string& path) {
  if (isGeoPackage(path)) return true;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;  // reading a FIFO would block
  std::ifstream stream(path, std::ios::binary);
  char c = ' ';
  while (std::isspace(static_cast<unsigned char>(c)) != 0 && stream.get(c)) continue;
  return c == '{';
}

RouteFile readRoute(const std::string& path) {
  const json document = parsed(path);
  const auto place = json::json_pointer("/features/0/properties");
  const json properties = document.contains(place) ? document.at(place) : json();
  const Fields fields(path, properties);
  RouteFile file;
  file.route.status = planner::RouteStatus::Found;
  readVertices(fields, file.route.vertices);
  requireLine(fields, document, file.route.vertices);
  const json summary = member(properties, "summary");
  static_cast<planner::RouteSummary&>(file.route) = summaryFrom(Fields(path, summary));
  if (const json drive = member(summary, "drive"); drive.is_object()) {
    readDrive(fields, file.route.vertices);
    file.route.drive = shapeFrom(Fields(path, drive));
  }
  file.inputs = inputsOf(properties);
  file.provenance = provenanceOf(member(properties, "inputs"));
  return file;
}

}  // namespace talus::cli
