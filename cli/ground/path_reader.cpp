#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/ground/path_reader.hpp>
#include <talus/common/input_error.hpp>
#include <talus/common/plausible.hpp>
#include <talus/maps/vector/vector_reader.hpp>
#include <talus/terramech/io/csv_reader.hpp>

namespace talus::cli {
namespace {

using maps::Point;
using nlohmann::json;

std::size_t columnOf(const terramech::CsvReader& reader, const std::string& name, const std::string& path) {
  const auto& header = reader.header();
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end())
    throw InputError(
        {path, fmt::format("no column {}", name), "a path needs the columns x_m and y_m, or a vector file"});
  return static_cast<std::size_t>(found - header.begin());
}

std::vector<Point> readCsv(const std::string& path) {
  terramech::CsvReader reader(path);
  const std::size_t x = columnOf(reader, "x_m", path), y = columnOf(reader, "y_m", path);
  std::vector<Point> points;
  for (terramech::CsvRow row; reader.next(row);) {
    Point p;
    const bool good = row.fault.empty() && terramech::parseNumber(row.fields[x], p.x_m) &&
                      terramech::parseNumber(row.fields[y], p.y_m) && plausible(p.x_m) && plausible(p.y_m);
    if (!good)
      throw InputError({fmt::format("{}:{}", path, row.line),
                        row.fault.empty() ? fmt::format("x_m, y_m: {}", kPlausible) : row.fault,
                        "fix the row"});
    points.push_back(p);
  }
  return points;
}

// Returns the map coordinates in the properties x_m, y_m of a route file. Without these properties the list
// is empty.
std::vector<Point> ownMetres(const std::string& path) {
  std::vector<Point> points;
  std::ifstream file(path);
  const json document = json::parse(file, nullptr, false);
  if (!document.is_object() || document.value("type", "") != "FeatureCollection" ||
      !document.contains("features"))
    return points;
  const json& features = document["features"];
  if (!features.is_array() || features.empty() || !features[0].contains("properties")) return points;
  const json& properties = features[0]["properties"];
  if (!properties.is_object() || !properties.contains("x_m") || !properties.contains("y_m")) return points;
  const json &x = properties["x_m"], &y = properties["y_m"];
  if (!x.is_array() || !y.is_array() || x.size() != y.size()) return points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!x[i].is_number() || !y[i].is_number()) return {};
    points.push_back({x[i].get<double>(), y[i].get<double>()});
  }
  return points;
}

// Tolerance between the coordinates of an unedited line and its x_m, y_m: programs write degrees with few
// digits.
constexpr double kRounding_cells = 0.1;

// Refuses a line whose coordinates differ from its x_m, y_m: the line was edited, and the intended values are
// unknown.
void requireSame(const std::vector<Point>& line, const std::vector<Point>& own, const maps::Grid& grid,
                 const std::string& path) {
  const auto refuse = [&](const std::string& reason) {
    throw InputError({path, reason, "remove the properties x_m and y_m to have its coordinates judged"});
  };
  const bool stands = own.size() == 1 && line.size() == 2;  // a line needs two positions
  if (line.size() != own.size() && !stands)
    refuse(fmt::format("has {} coordinates, but {} values of x_m: it was edited", line.size(), own.size()));
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Point& at = own[std::min(i, own.size() - 1)];
    const double off_m = std::hypot(line[i].x_m - at.x_m, line[i].y_m - at.y_m);
    if (!(off_m <= kRounding_cells * grid.resolution_m))
      refuse(
          fmt::format("vertex {}: its coordinates lie {:.3g} m from its x_m, y_m: it was edited, or is of a "
                      "map with another CRS",
                      i + 1, off_m));
  }
}

std::vector<Point> drawnPath(const std::string& path, const maps::ElevationMap& map) {
  std::vector<Point> line = maps::readLine(path, map), own = ownMetres(path);
  if (own.empty()) return line;
  requireSame(line, own, map.grid(), path);
  return own;
}

// Limits the distance from the map and the length of a path, because the path is checked piece by piece and
// cell by cell.
void requireNear(const std::vector<Point>& points, const maps::Grid& grid, const std::string& path) {
  const double around_m = 1e6 * grid.resolution_m;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double east = points[i].x_m - grid.south_west.x_m, north = points[i].y_m - grid.south_west.y_m;
    const bool near = east >= -around_m && north >= -around_m &&
                      east <= grid.width * grid.resolution_m + around_m &&
                      north <= grid.height * grid.resolution_m + around_m;
    if (!near)
      throw InputError(
          {path,
           fmt::format("vertex {} at {:.6g},{:.6g} lies farther than {:.6g} m, a million cells, from the map",
                       i + 1, points[i].x_m, points[i].y_m, around_m),
           "check the coordinate system"});
  }
  constexpr double kMostCells = 4e6;  // from one distant corner to the other
  double length_m = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    length_m += std::hypot(points[i].x_m - points[i - 1].x_m, points[i].y_m - points[i - 1].y_m);
  if (length_m > kMostCells * grid.resolution_m)
    throw InputError(
        {path, fmt::format("is {:.6g} m long, more than 4 million cells", length_m), "split it"});
}

}  // namespace

std::vector<Point> readPath(const std::string& path, const maps::ElevationMap& map) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  const bool table = extension == ".csv" || extension == ".txt";
  std::vector<Point> points = table ? readCsv(path) : drawnPath(path, map);
  if (points.empty()) throw InputError({path, "contains no point", "a path needs at least one"});
  maps::requireFewPositions(points.size(), path);
  requireNear(points, map.grid(), path);
  return points;
}

}  // namespace talus::cli
