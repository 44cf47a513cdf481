#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/options.hpp>
#include <talus/cli/draw/scene.hpp>
#include <talus/cli/ground/ground_options.hpp>
#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>
#include <talus/costmap/map/ground_curves.hpp>
#include <talus/costmap/surface/surface_tree.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/vector/vector_reader.hpp>
#include <talus/terramech/io/csv_reader.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::cli {

namespace {

using costmap::CellCode;
using costmap::TraversabilityMap;

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

// Energy [J/m] straight up (sign 1) or down (-1) the slope of the cell; NaN if the direction is refused.
float energyAlong(const costmap::CostGrid& grid, maps::Cell cell, double sign) {
  const CellCode code = grid.at(cell);
  const double steepness = std::hypot(code.dzDx(), code.dzDy());
  const costmap::Direction up =
      steepness > 0.0 ? costmap::Direction{sign * code.dzDx() / steepness, sign * code.dzDy() / steepness}
                      : costmap::Direction{};
  if (!std::isfinite(grid.cost().costPerMetre(code, up))) return kNoValue;
  return grid.cost().detail(code, up).energy_J_per_m;
}

}  // namespace

std::vector<maps::Layer> siteLayers(const TraversabilityMap& map, int threads) {
  const maps::Grid& grid = map.grid();
  maps::TerrainMetrics metrics =
      maps::terrainMetrics(map.elevation().elevation_m, map.surface().footprint(threads));
  const auto published = map.published();
  const auto known = [&](maps::Cell cell, float value) {
    return map.surface().classIndex(cell) < 0 ? kNoValue : value;
  };
  costmap::PlaceBeliefs beliefs(map);
  HeadingsOfCells headings(map);
  std::vector<maps::Layer> layers;
  const auto add = [&](const char* name, const char* unit, const std::function<float(maps::Cell)>& value) {
    layers.push_back({name, unit, maps::Raster<float>(grid)});
    costmap::forEachCell(costmap::allOf(grid), [&](maps::Cell c) { layers.back().values[c] = value(c); });
  };
  layers.push_back({"elevation", "m", map.elevation().elevation_m});
  add("slope", "rad", [&](maps::Cell c) { return metrics.slope_rad(c); });
  add("aspect", "rad", [&](maps::Cell c) { return metrics.aspect_rad(c); });
  layers.push_back({"roughness", "m", std::move(metrics.roughness_m)});
  layers.push_back({"step", "m", std::move(metrics.step_m)});
  add("class", "", [&](maps::Cell c) { return static_cast<float>(map.surface().classNumber(c)); });
  add("category", "", [&](maps::Cell c) { return static_cast<float>(beliefs.at(c).category); });
  add("allowed_headings", "", [&](maps::Cell c) { return static_cast<float>(headings.at(c)); });
  add("drawbar_pull_over_load", "", [&](maps::Cell c) { return known(c, beliefs.at(c).pull_mean); });
  add("drawbar_pull_over_load_std", "", [&](maps::Cell c) { return known(c, beliefs.at(c).pull_std); });
  add("sinkage_over_radius", "", [&](maps::Cell c) { return known(c, beliefs.at(c).sinkage_mean); });
  add("energy_per_metre_uphill", "J/m", [&](maps::Cell c) { return energyAlong(*published, c, 1.0); });
  add("energy_per_metre_downhill", "J/m", [&](maps::Cell c) { return energyAlong(*published, c, -1.0); });
  return layers;
}

void addMapOptions(CLI::App& command, ElevationFile& file, const std::string& name) {
  addOption(command, name, file.path)->required();
  addReadOptions(command, file);
}

void addReadOptions(CLI::App& command, ElevationFile& file) {
  maps::ReadOptions& read = file.read;
  addOption(command, "--band N", read.band);
  addOption(command, "--resolution METRES", read.resolution_m);
  addOption(command, "--window BOX", file.window);
  addOption(command, "--nodata VALUE", read.nodata);
  command.add_flag("--keep-holes", read.keep_holes);
  addOption(command, "--vertical-scale FACTOR", read.vertical_scale);
  command.add_flag("--ignore-crs", read.ignore_crs);
  command.add_flag("--allow-vrt", read.allow_vrt);
  addOption(command, "--below METRES", file.below_m);
  addOption(command, "--max-cells N", read.max_cells)->check(within(1.0, 1e15));
}

SiteReading readingOf(const Context& context) {
  return {.threads = context.workers(),
          .note = [&context](std::string_view line) { context.warn(line); },
          .watch = context.watch("read map")};
}

namespace {

using Clock = std::chrono::steady_clock;

double since_s(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

constexpr float kSameHeight_m = 0.01F;

bool isBeliefMap(const std::string& path) {
  return costmap::octomapType(path) == "TraversabilityTree";
}

// Returns true if no elevation map is given in addition to the built map.
bool isBuiltAlone(const GroundOptions& options, const std::string& path) {
  return options.elevation.path.empty() || options.elevation.path == path ||
         isBeliefMap(options.elevation.path);
}

// A built map has its own grid, layers, soils, rover and policy; conflicting options of the call are refused.
// With an additional elevation map, options may repeat how that map is read and how the built map was built.
void checkAgainstMap(const GroundOptions& options, const std::string& path, const Context& context) {
  const bool alone = isBuiltAlone(options, path);
  if (alone) refuseReadOptions(options.elevation);
  const std::tuple<std::string, bool, bool> given[] = {
      {"--keep-out", true, !options.keep_out.empty()},
      {"--layer", true, !options.costs.empty()},
      {"an option of thresholds, weights and risk", true, options.policy != costmap::TravelPolicy{}},
      {"--below", alone, alone && options.elevation.below_m.has_value()},
      {"--terrain", alone, !options.classes.empty() || options.classes_band},
      {"--rocks", alone, !options.rocks.empty() || options.rocks_band},
      {"--soils", alone, !options.soils.empty()},
      {"--soil", alone, !options.soil.empty()},
      {"--model", alone, !options.model.empty()},
      {"--footprint", alone, options.footprint_m != 0.0}};
  for (const auto& [name, refused, present] : given) {
    if (present && refused)
      throw InputError({path, "is a built map, on which " + name + " has no effect",
                        "give " + name + " to talus costmap, or plan on the elevation map"});
    if (present) context.warn(name + " has no effect: " + path + " has its own");
  }
}

// Compares the rover of the call with the rover of the map: slopes, costs and shapes are valid for one rover
// only.
void checkSameRover(const GroundOptions& options, const terramech::Rover& own, const std::string& path) {
  if (options.rover.empty()) return;
  terramech::Rover given = terramech::loadRover(options.rover);
  given.name = own.name;
  if (!(given == own))
    throw InputError({path, "was built for rover '" + own.name + "', not for --rover " + options.rover,
                      "build a map for that one with talus costmap"});
}

// An elevation map given beside a built map identifies the site: routes planned on other slopes would be
// wrong.
void checkSameSite(const maps::ElevationMap& dem, const costmap::TraversabilityMap& map,
                   const std::string& path) {
  const maps::Grid &a = dem.grid(), &b = map.grid();
  const auto refuse = [&](const std::string& reason) {
    throw InputError({path, "was not built from " + dem.source + ": " + reason,
                      "name the elevation map that it was built from, or none but the map"});
  };
  const double near = 1e-6 * b.resolution_m;
  if (a.width != b.width || a.height != b.height || std::abs(a.resolution_m - b.resolution_m) > near ||
      std::abs(a.south_west.x_m - b.south_west.x_m) > near ||
      std::abs(a.south_west.y_m - b.south_west.y_m) > near)
    refuse(fmt::format("{} x {} cells of {:.6g} m against {} x {} of {:.6g} m, or another place", a.width,
                       a.height, a.resolution_m, b.width, b.height, b.resolution_m));
  const auto &heights = dem.elevation_m.values(), &own = map.elevation().elevation_m.values();
  for (std::size_t i = 0; i < heights.size(); ++i)
    if (std::isnan(heights[i]) != std::isnan(own[i]) || std::abs(heights[i] - own[i]) > kSameHeight_m)
      refuse(fmt::format("elevation {:.6g} m against {:.6g} m in cell {}", heights[i], own[i], i));
}

// Elevation map given in addition to a built map; nothing, with a warning, if there is no such file.
std::optional<maps::ElevationMap> siteOf(const GroundOptions& options, const std::string& path,
                                         const Context& context) {
  if (isBuiltAlone(options, path)) return std::nullopt;
  if (std::filesystem::exists(options.elevation.path)) return readMap(options.elevation, readingOf(context));
  context.warn(path + " is not compared with the elevation map: " + options.elevation.path +
               ": no such file");
  return std::nullopt;
}

Ground fromMapFile(const GroundOptions& options, const std::string& path, const Context& context) {
  checkAgainstMap(options, path, context);
  const auto begin = Clock::now();
  const InputRecord record;
  Ground ground{readBuiltMap(path, readingOf(context)), {}};
  checkSameRover(options, ground.map.model().rover(), path);
  if (const auto dem = siteOf(options, path, context)) checkSameSite(*dem, ground.map, path);
  ground.files = manifestOf(options.files());
  const auto& before = ground.map.elevation().files;
  ground.files.insert(ground.files.end(), before.begin(), before.end());
  ground.load_s = since_s(begin);
  for (const std::string& line : terramech::slopeAssumptions(ground.map.model().rover())) context.warn(line);
  return ground;
}

}  // namespace

SiteFiles GroundOptions::files() const {
  SiteFiles files = *this;
  for (const auto& [path, role] : {std::pair{map_file, "map"}, {mission, "mission"}})
    if (!path.empty()) files.further.push_back({.path = path, .role = role});
  return files;
}

void addGroundOptions(CLI::App& command, GroundOptions& options) {
  options.call = &command;
  addMapOptions(command, options.elevation);
  addOption(command, "--map MAP.ot", options.map_file);
  addGroundChoices(command, options);
}

void addGroundChoices(CLI::App& command, GroundOptions& options) {
  addOption(command, "--terrain FILE", options.classes);
  addOption(command, "--terrain-band N", options.classes_band);
  addOption(command, "--rocks FILE", options.rocks);
  addOption(command, "--rocks-band N", options.rocks_band);
  addOption(command, "--keep-out FILE", options.keep_out);
  addOption(command, "--layer NAME=FILE", options.costs);
  addOption(command, "--soils FILE", options.soils);
  auto* soil = addOption(command, "--soil SOIL", options.soil);
  addOption(command, "--model M.yaml", options.model)->excludes(soil);
  addOption(command, "--rover ROVER", options.rover);
  addOption(command, "--footprint METRES", options.footprint_m)->check(notNegative());
  costmap::TravelPolicy& policy = options.policy;
  command.add_flag("--no-marginal{false}", policy.allow_marginal);
  command.add_flag("--allow-dangerous", policy.allow_dangerous);
  command.add_flag("--allow-unknown", policy.allow_unknown);
  command
      .add_option_function<double>("--slope-uncertainty-deg",
                                   [&policy](double deg) { policy.slope_margin_rad = deg * kDegree; })
      ->type_name("DEG");
  addOption(command, "--time-weight W", policy.time_weight_W);
  addOption(command, "--entrapment FRACTION", policy.entrapment)->check(CLI::Range(0.0, 1.0));
  command.add_flag("--unmonitored", policy.unmonitored);
  addOption(command, "--pose-error METRES", policy.pose_error_m)->check(CLI::Range(0.0, 100.0));
  addOption(command, "--risk-weight J", policy.risk_weight_J);
}

void addCostCurve(CLI::App& command, GroundOptions& options) {
  addOption(command, "--cost-curve FILE.csv", options.cost_curve);
  command.add_flag("--cost", options.is_cost)->excludes("--cost-curve");
}

Ground readGround(const GroundOptions& options, const Context& context) {
  if (!options.cost_curve.empty() && (!options.map_file.empty() || isBeliefMap(options.elevation.path)))
    throw InputError({"--cost-curve " + options.cost_curve,
                      "has no effect on a built map, which has its own costs", "plan on the elevation map"});
  if (!options.map_file.empty()) return fromMapFile(options, options.map_file, context);
  if (isBeliefMap(options.elevation.path)) return fromMapFile(options, options.elevation.path, context);
  auto begin = Clock::now();
  Site site = readSite(options.files(), readingOf(context));
  std::vector<InputFile> files = site.layers.elevation.files;
  const double load_s = since_s(begin);
  begin = Clock::now();
  costmap::TraversabilityMap map = traversabilityMap(std::move(site), context.watch("costmap"));
  return {std::move(map), std::move(files), load_s, since_s(begin)};
}

namespace {

constexpr double kOverviewCells = 2'000'000;
constexpr std::int64_t kPixelCache = 64 << 20;  // bytes

maps::Grid wholeGrid(const GroundOptions& options) {
  maps::ReadOptions read = options.elevation.read;
  if (!options.elevation.window.empty()) read.window = maps::parseWindow(options.elevation.window);
  return maps::elevationGrid(options.elevation.path, read);
}

}  // namespace

bool needsWindows(const GroundOptions& options, std::size_t cells) {
  if (!options.map_file.empty() || costmap::octomapType(options.elevation.path)) return false;
  return wholeGrid(options).size() > cells;
}

Ground readOverview(const GroundOptions& options, const Context& context) {
  maps::limitPixelCache(kPixelCache);
  GroundOptions coarse = options;
  const auto cells = static_cast<double>(wholeGrid(options).size());
  coarse.elevation.read.overview =
      std::max(2, static_cast<int>(std::ceil(std::sqrt(cells / kOverviewCells))));
  return readGround(coarse, context);
}

planner::WindowedMap windowsOn(const GroundOptions& options, const Ground& overview, const Context& context) {
  const auto build = [part = options, quiet = context](
                         const planner::MapBox& box) mutable -> std::optional<costmap::TraversabilityMap> {
    quiet.quiet = true;  // warnings were printed for the overview
    part.elevation.window.clear();
    part.elevation.read.window = maps::Window{box.low, box.high};
    try {
      return readGround(part, quiet).map;
    } catch (const InputError&) {  // window without data
      return std::nullopt;
    }
  };
  return planner::WindowedMap(
      {.grid = wholeGrid(options), .overview = overview.map.published(), .build = build});
}

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
  if (!document.is_object()) return points;
  const json::json_pointer properties("/features/0/properties");
  const json x = document.value(properties / "x_m", json()), y = document.value(properties / "y_m", json());
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
