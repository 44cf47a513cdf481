#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/ground/path_reader.hpp>
#include <talus/common/common.hpp>
#include <talus/common/plausible.hpp>
#include <talus/maps/maps.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/vector/vector_reader.hpp>
#include <talus/terramech/io/csv_reader.hpp>

namespace talus::cli {
namespace {

using maps::Point;
using nlohmann::json;

// Columns of places by their names in lower case, without a unit. A table is read by the first pair that it has: names
// that state the frame or the unit precede x and y.
struct PlaceColumns {
  std::string_view x, y, unit;
  bool stated;
};
constexpr PlaceColumns kPlaceColumns[] = {{"x", "y", "m", true},
                                          {"lon", "lat", "deg", true},
                                          {"lng", "lat", "deg", true},
                                          {"longitude", "latitude", "deg", true},
                                          {"easting", "northing", "m", false},
                                          {"x", "y", "m", false}};

std::vector<Point> readCsv(const std::string& path, const maps::ElevationMap& map) {
  terramech::CsvReader reader(path);
  const auto& header = reader.header();
  // Returns the place of a column in the header and the factor to its unit.
  const auto find = [&](std::string_view stem,
                        const PlaceColumns& pair) -> std::optional<std::pair<std::size_t, double>> {
    for (std::size_t k = 0; k < header.size(); ++k) {
      const std::string name = maps::lower(terramech::plainName(header[k]));
      const std::string_view unit = terramech::unitOf(name);
      const auto factor = unit.empty() ? 1.0 : terramech::conversion(unit, pair.unit);
      if (terramech::stemOf(name) == stem && factor && (!unit.empty() || !pair.stated || pair.unit != "m"))
        return std::pair{k, *factor};
    }
    return std::nullopt;
  };
  const auto known = std::ranges::find_if(
      kPlaceColumns, [&](const PlaceColumns& pair) { return find(pair.x, pair) && find(pair.y, pair); });
  if (known == std::end(kPlaceColumns))
    throw InputError(
        {path, "names no columns of places",
         "a path needs the columns x_m and y_m (x and y, easting and northing: metres of the map), or "
         "lat and lon (degrees)"});
  const auto [x, x_factor] = *find(known->x, *known);
  const auto [y, y_factor] = *find(known->y, *known);
  const bool degrees = known->unit == "deg";
  std::vector<Point> points;
  bool bare = !known->stated;  // whether all places are places of the map in degrees
  for (terramech::CsvRow row; reader.next(row);) {
    const std::string where = fmt::format("{}:{}", path, row.line);
    Point p;
    bool good = row.fault.empty() && terramech::parseNumber(row.fields[x], p.x_m) &&
                terramech::parseNumber(row.fields[y], p.y_m) && plausible(p.x_m) && plausible(p.y_m);
    p = {p.x_m * x_factor, p.y_m * y_factor};
    good = good && (!degrees || (std::abs(p.x_m) <= 360.0 && std::abs(p.y_m) <= 90.0));
    if (!good)
      throw InputError({where,
                        !row.fault.empty() ? row.fault
                        : degrees          ? "must be a latitude within 90 and a longitude within 360 degrees"
                                           : fmt::format("{}, {}: {}", known->x, known->y, kPlausible),
                        "fix the row"});
    if (degrees) p = maps::inMetres(maps::GeoPoint{p.y_m * kDegree, p.x_m * kDegree}, map, where);
    bare = bare && maps::asDegrees(p, map);
    points.push_back(p);
  }
  if (bare && !points.empty())
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
  const json::json_pointer properties("/features/0/properties");
  if (!document.contains(properties / "x_m") || !document.contains(properties / "y_m")) return points;
  const json &x = document[properties / "x_m"], &y = document[properties / "y_m"];
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

// Limits the length of a path and of the way to it, because it is checked piece by piece and cell by cell.
void requireNear(const std::vector<Point>& points, const maps::Grid& grid, const std::string& path) {
  constexpr double kMostCells = 4e6;  // from one distant corner to the other
  double length_m = 0.0;
  Point last = grid.south_west;
  for (const Point p : points) {
    length_m += std::hypot(p.x_m - last.x_m, p.y_m - last.y_m);
    last = p;
  }
  if (length_m > kMostCells * grid.resolution_m)
    throw InputError({path, fmt::format("is {:.6g} m long from the map, more than 4 million cells", length_m),
                      "check its coordinate system, or split it"});
}

}  // namespace

std::vector<Point> readPath(const std::string& path, const maps::ElevationMap& map) {
  const std::string extension = maps::lower(std::filesystem::path(path).extension().string());
  const bool table = extension == ".csv" || extension == ".txt" || extension == ".tsv";
  std::vector<Point> points = table ? readCsv(path, map) : drawnPath(path, map);
  if (points.empty()) throw InputError({path, "contains no point", "a path needs at least one"});
  maps::requireFewPositions(points.size(), path);
  requireNear(points, map.grid(), path);
  return points;
}

}  // namespace talus::cli
