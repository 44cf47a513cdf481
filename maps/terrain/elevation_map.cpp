#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>
#include <talus/maps/maps.hpp>

namespace talus::maps {

double validFraction(const Raster<float>& elevation_m) {
  const auto& z = elevation_m.values();
  if (z.empty()) return 0.0;
  const auto valid = std::count_if(z.begin(), z.end(), [](float v) { return !std::isnan(v); });
  return static_cast<double>(valid) / static_cast<double>(z.size());
}

std::optional<double> elevationAt(const Raster<float>& elevation_m, Point point) {
  return elevationAt(elevation_m.grid(), point, [&](Cell cell) { return elevation_m[cell]; });
}

std::optional<double> elevationAt(const Grid& grid, Point point,
                                  const std::function<float(Cell)>& elevation_m) {
  if (!grid.cellAt(point)) return std::nullopt;
  // Column and row of the point [cells] from the centre of cell (0, 0), clamped: within half a cell of the
  // border, the elevation is that of the border cells.
  const double column =
      std::clamp((point.x_m - grid.south_west.x_m) / grid.resolution_m - 0.5, 0.0, grid.width - 1.0);
  const double row =
      std::clamp((point.y_m - grid.south_west.y_m) / grid.resolution_m - 0.5, 0.0, grid.height - 1.0);
  const Cell sw{static_cast<int>(column), static_cast<int>(row)};
  const Cell ne{std::min(sw.column + 1, grid.width - 1), std::min(sw.row + 1, grid.height - 1)};
  const double u = column - sw.column;
  const double v = row - sw.row;
  const auto z = [&](int c, int r) { return static_cast<double>(elevation_m({c, r})); };
  // A corner with weight 0 may be without data.
  const auto mix = [](double a, double b, double t) { return t == 0 ? a : a + (b - a) * t; };
  const double south = mix(z(sw.column, sw.row), z(ne.column, sw.row), u);
  const double value = v == 0 ? south : mix(south, mix(z(sw.column, ne.row), z(ne.column, ne.row), u), v);
  if (std::isnan(value)) return std::nullopt;
  return value;
}

namespace {

struct Coordinate {
  double value = 0.0;
  bool degrees = false;
};

[[noreturn]] void refuse(std::string_view text, const std::string& reason) {
  throw InputError({"'" + std::string(text) + "'", reason,
                    "write x,y in map metres or latitude,longitude with a d on each (-4.59d,137.44d)"});
}

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && s.front() == ' ') s.remove_prefix(1);
  while (!s.empty() && s.back() == ' ') s.remove_suffix(1);
  return s;
}

Coordinate parseCoordinate(std::string_view word, std::string_view whole) {
  word = trimmed(word);
  Coordinate out;
  if (word.ends_with('d')) {
    out.degrees = true;
    word.remove_suffix(1);
  }
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), out.value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(out.value))
    refuse(whole, "'" + std::string(word) + "' is not a number");
  if (!isDecimal(word)) refuse(whole, "'" + std::string(word) + "' is not decimal, without leading zeros");
  return out;
}

std::vector<Coordinate> parseList(std::string_view text, std::size_t count) {
  std::vector<Coordinate> out;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    out.push_back(parseCoordinate(rest.substr(0, comma), text));
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (out.size() != count) refuse(text, "has not " + std::to_string(count) + " numbers");
  return out;
}

Place toPlace(Coordinate first, Coordinate second, std::string_view text) {
  if (first.degrees != second.degrees) refuse(text, "only one number has a d for degrees");
  if (!first.degrees) return Point{first.value, second.value};
  if (std::abs(first.value) > 90) refuse(text, "latitude is not within 90 degrees");
  if (std::abs(second.value) > 360) refuse(text, "longitude is not within 360 degrees");
  return GeoPoint{first.value * kDegree, second.value * kDegree};
}

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

std::string degrees(GeoPoint place) {
  return format("%.6fd,%.6fd", place.latitude_rad / kDegree, place.longitude_rad / kDegree);
}

}  // namespace

Place parsePlace(std::string_view text) {
  const auto numbers = parseList(text, 2);
  return toPlace(numbers[0], numbers[1], text);
}

Window parseWindow(std::string_view text) {
  const auto numbers = parseList(text, 4);
  if (numbers[0].degrees != numbers[2].degrees) refuse(text, "one corner is in metres, the other in degrees");
  return {toPlace(numbers[0], numbers[1], text), toPlace(numbers[2], numbers[3], text)};
}

namespace {

// Moves a point on the eastern or northern border of the map into the last cell. Elsewhere a cell includes
// its western and southern side.
double withinBorder(double at_m, double from_m, int cells, double resolution_m) {
  const double border_m = from_m + cells * resolution_m;
  return at_m == border_m ? border_m - 1e-6 * resolution_m : at_m;
}

}  // namespace

std::optional<GeoPoint> asDegrees(Point given, const ElevationMap& map) {
  const Georeference* places = map.places();
  for (const auto& [latitude, longitude] : {std::pair{given.x_m, given.y_m}, {given.y_m, given.x_m}}) {
    if (places == nullptr || std::abs(latitude) > 90 || std::abs(longitude) > 360) continue;
    const GeoPoint as_degrees{latitude * kDegree, longitude * kDegree};
    const auto cell = map.grid().cellAt(places->forward(as_degrees));
    if (cell && cell != map.grid().cellAt(given)) return as_degrees;
  }
  return std::nullopt;
}

Point inMetres(const Place& place, const ElevationMap& map, const std::string& name) {
  if (const auto* point = std::get_if<Point>(&place)) return *point;
  if (const Georeference* places = map.places()) return places->forward(std::get<GeoPoint>(place));
  throw InputError({name,
                    "map '" + map.source + "' has no CRS for a latitude and longitude" +
                        (map.georeference ? " that is known without PROJ" : ""),
                    "give x,y in map metres"});
}

Point locate(const Place& place, const ElevationMap& map, const std::string& name) {
  const Point given = inMetres(place, map, name);
  const bool geographic = std::holds_alternative<GeoPoint>(place);
  if (const auto bare = geographic ? std::nullopt : asDegrees(given, map))
    throw InputError({name, "metres without a suffix, and a place of the map if it is in degrees",
                      "write " + degrees(*bare) + " for latitude and longitude"});
  const Grid& grid = map.grid();
  const Point point{withinBorder(given.x_m, grid.south_west.x_m, grid.width, grid.resolution_m),
                    withinBorder(given.y_m, grid.south_west.y_m, grid.height, grid.resolution_m)};
  if (grid.cellAt(point)) return point;
  const std::string where = geographic ? " at " + degrees(std::get<GeoPoint>(place)) : "";
  throw InputError({name,
                    format("x %.10g m, y %.10g m", point.x_m, point.y_m) + where + " lies outside the map",
                    "the map " + extent(map.grid())});
}

std::string extent(const Grid& grid) {
  return format("spans x %.10g to %.10g m, y %.10g to %.10g m", grid.south_west.x_m,
                grid.south_west.x_m + grid.width * grid.resolution_m, grid.south_west.y_m,
                grid.south_west.y_m + grid.height * grid.resolution_m);
}

std::string describe(Point point, const ElevationMap& map) {
  const std::string metres = format("x %.2f m, y %.2f m", point.x_m, point.y_m);
  const Georeference* places = map.places();
  return places != nullptr ? metres + " (" + degrees(places->reverse(point)) + ")" : metres;
}

}  // namespace talus::maps
