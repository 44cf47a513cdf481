#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/ground/path_reader.hpp>
#include <talus/common/constants.hpp>
#include <talus/common/input_error.hpp>
#include <talus/common/plausible.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/terrain/place.hpp>
#include <talus/maps/vector/vector_reader.hpp>
#include <talus/terramech/io/column_units.hpp>
#include <talus/terramech/io/csv_reader.hpp>
#include <talus/terramech/io/field_text.hpp>

namespace talus::cli {
namespace {

using maps::Point;
using nlohmann::json;

// Columns of places by their names in lower case, with _ between words. A table is read by the first pair that it
// has: names that state the frame precede x and y.
struct PlaceColumns {
  std::string_view x, y;
  enum { Metres, Degrees, Unstated } unit;
};
constexpr PlaceColumns kPlaceColumns[] = {{"x_m", "y_m", PlaceColumns::Metres},
                                          {"easting_m", "northing_m", PlaceColumns::Metres},
                                          {"lon", "lat", PlaceColumns::Degrees},
                                          {"lng", "lat", PlaceColumns::Degrees},
                                          {"longitude", "latitude", PlaceColumns::Degrees},
                                          {"lon_deg", "lat_deg", PlaceColumns::Degrees},
                                          {"longitude_deg", "latitude_deg", PlaceColumns::Degrees},
                                          {"easting", "northing", PlaceColumns::Unstated},
                                          {"x", "y", PlaceColumns::Unstated}};

std::vector<Point> readCsv(const std::string& path, const maps::ElevationMap& map) {
  terramech::CsvReader reader(path);
  std::vector<std::string> names;
  for (const std::string& name : reader.header()) names.push_back(maps::lower(terramech::plainName(name)));
  const auto column = [&](std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  };
  const auto known = std::ranges::find_if(kPlaceColumns, [&](const PlaceColumns& pair) {
    return std::max(column(pair.x), column(pair.y)) < names.size();
  });
  if (known == std::end(kPlaceColumns))
    throw InputError(
        {path, "names no columns of places",
         "a path needs the columns x_m and y_m (x and y, easting and northing: metres of the map), or "
         "lat and lon (degrees)"});
  const std::size_t x = column(known->x), y = column(known->y);
  std::vector<Point> points;
  bool all_bare = known->unit == PlaceColumns::Unstated;
  for (terramech::CsvRow row; reader.next(row);) {
    const std::string where = fmt::format("{}:{}", path, row.line);
    Point p;
    const bool degrees = known->unit == PlaceColumns::Degrees;
    const bool good = row.fault.empty() && terramech::parseNumber(row.fields[x], p.x_m) &&
                      terramech::parseNumber(row.fields[y], p.y_m) && plausible(p.x_m) && plausible(p.y_m) &&
                      (!degrees || (std::abs(p.x_m) <= 360.0 && std::abs(p.y_m) <= 90.0));
    if (!good)
      throw InputError({where,
                        !row.fault.empty() ? row.fault
                        : degrees          ? "must be a latitude within 90 and a longitude within 360 degrees"
                                           : fmt::format("{}, {}: {}", known->x, known->y, kPlausible),
                        "fix the row"});
    if (degrees) p = maps::inMetres(maps::GeoPoint{p.y_m * kDegree, p.x_m * kDegree}, map, where);
    all_bare = all_bare && maps::asDegrees(p, map);
    points.push_back(p);
  }
  if (all_bare && !points.empty())
    throw InputError({path, "has places of the map if its columns are in degrees, not in metres",
                      "name them lat and lon, or x_m and y_m"});
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
  const bool table = extension == ".csv" || extension == ".txt" || extension == ".tsv";
  std::vector<Point> points = table ? readCsv(path, map) : drawnPath(path, map);
  if (points.empty()) throw InputError({path, "contains no point", "a path needs at least one"});
  maps::requireFewPositions(points.size(), path);
  requireNear(points, map.grid(), path);
  return points;
}

}  // namespace talus::cli
