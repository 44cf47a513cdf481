#include <numeric>

#include <fmt/format.h>

#include <talus/cli/app/context.hpp>
#include <talus/cli/draw/route_summary.hpp>
#include <talus/cli/draw/scene.hpp>
#include <talus/common/common.hpp>
#include <talus/costmap/map/ground_curves.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/planner/reach/reach.hpp>

namespace talus::cli {

double roundBelow(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value) + 1e-12));
  const double mantissa = value / power * (1.0 + 1e-12);
  return power * (mantissa >= 5.0 ? 5.0 : mantissa >= 2.0 ? 2.0 : 1.0);
}

using costmap::CellCode;

HeadingsOfCells::HeadingsOfCells(const costmap::TraversabilityMap& map)
    : map_(map), grid_(map.published()), sets_(grid_->cost()), known_(grid_->cost().curves().size()) {}

AllowedHeadings HeadingsOfCells::at(maps::Cell cell) {
  const CellCode code = grid_->at(cell);
  if (code.curve() >= CellCode::kUnknown)
    return map_.costs().category(cell) == static_cast<std::uint8_t>(terramech::Category::Unknown)
               ? AllowedHeadings::Unknown
               : AllowedHeadings::None;
  const double steepness = std::hypot(code.stepsX(), code.stepsY());
  const AllowedHeadings gentler = on(code.curve(), static_cast<int>(std::floor(steepness))),
                        steeper = on(code.curve(), static_cast<int>(std::ceil(steepness)));
  return gentler == steeper ? gentler : of(code);
}

AllowedHeadings HeadingsOfCells::on(CellCode::Curve curve, int steepness) {
  std::vector<AllowedHeadings>& known = known_[curve];
  const auto step = static_cast<std::size_t>(steepness);
  if (known.size() <= step) known.resize(step + 1, AllowedHeadings::Unknown);
  if (known[step] == AllowedHeadings::Unknown)
    known[step] = of(CellCode({.dz_dx = steepness * CellCode::kStep, .dz_dy = 0.0, .curve = curve}));
  return known[step];
}

AllowedHeadings HeadingsOfCells::of(CellCode code) {
  const planner::HeadingSet& set = sets_.of(code);
  return set.all() ? AllowedHeadings::All : set.empty() ? AllowedHeadings::None : AllowedHeadings::Some;
}

namespace {

using maps::Cell;
using maps::Raster;
using planner::Reach;

Range scaleRange(const Raster<float>& values) {
  const std::vector<double> ends = quantiles(values, kInner);
  if (std::isnan(ends[0])) return {};
  return {ends[0], ends[1] > ends[0] ? ends[1] : ends[0] + 1.0};
}

/// Averages of the map's estimates over the cells of each block; NaN if no cell has a category.
struct BlockBeliefs {
  Raster<HeadingShares> headings;
  Raster<float> pull, pull_std, sinkage;
};

BlockBeliefs beliefsOf(const costmap::TraversabilityMap& map, const Blocks& blocks) {
  const Raster<float> nothing(blocks.coarse(), std::nanf(""));
  BlockBeliefs out{Raster<HeadingShares>(blocks.coarse()), nothing, nothing, nothing};
  costmap::PlaceBeliefs beliefs(map);
  HeadingsOfCells headings(map);
  costmap::forEachCell(costmap::allOf(blocks.coarse()), [&](Cell block) {
    double pull = 0.0, pull_std = 0.0, sinkage = 0.0, count = 0.0;
    blocks.forEach(block, [&](Cell cell) {
      const costmap::CellBelief belief = beliefs.at(cell);
      ++out.headings[block].count[static_cast<std::size_t>(headings.at(cell))];
      if (belief.category > 2) return;
      pull += static_cast<double>(belief.pull_mean);
      pull_std += static_cast<double>(belief.pull_std);
      sinkage += static_cast<double>(belief.sinkage_mean);
      count += 1.0;
    });
    if (!(count > 0.0)) return;
    out.pull[block] = static_cast<float>(pull / count);
    out.pull_std[block] = static_cast<float>(pull_std / count);
    out.sinkage[block] = static_cast<float>(sinkage / count);
  });
  return out;
}

HeadingCosts headingCosts(const costmap::TraversabilityMap& map, const Blocks& blocks) {
  const auto version = map.published();
  HeadingCosts out{Raster<costmap::CellCode>(blocks.coarse()), Raster<std::uint8_t>(blocks.coarse()),
                   std::shared_ptr<const costmap::TravelCost>(version, &version->cost())};
  costmap::forEachCell(costmap::allOf(blocks.coarse()), [&](Cell block) {
    const Cell cell = blocks.middle(block);
    out.codes[block] = version->at(cell);
    out.categories[block] = map.costs().category(cell);
  });
  return out;
}

void addLayer(Scene& scene, const std::string& name, Raster<float> values, const std::string& unit = "",
              int decimals = 4) {
  const Range range = scaleRange(values);
  scene.layers.push_back({name, unit, std::move(values), range, false, decimals});
}

/// Adds an area of the blocks in which holds(cell) is true of a cell, unless there is none.
template <typename Holds>
void addArea(Scene& scene, const std::string& name, Colour colour, const Blocks& blocks, Holds holds) {
  HatchedArea area{name, colour, Raster<std::uint8_t>(blocks.coarse())};
  costmap::forEachCell(costmap::allOf(blocks.coarse()), [&](Cell block) {
    blocks.forEach(block, [&](Cell cell) {
      if (holds(cell)) area.mask[block] = 1;
    });
  });
  if (std::ranges::count(area.mask.values(), 1) > 0) scene.areas.push_back(std::move(area));
}

/// Adds what a mission adds to the ground: keep-out areas, and each cost layer with its area.
void addMissionLayers(Scene& scene, const costmap::TraversabilityMap& map, const Blocks& blocks) {
  for (const costmap::CostLayer& layer : map.surface().costLayers()) {
    const std::size_t before = scene.areas.size();
    addArea(scene, "layer " + layer.name, seriesColour(3), blocks, [&](Cell cell) {
      return std::isfinite(layer.added_J_per_m[cell]) && layer.added_J_per_m[cell] > 0.0F;
    });
    if (scene.areas.size() == before) continue;
    addLayer(scene, "layer " + layer.name, blocks.mean([&](Cell cell) { return layer.added_J_per_m[cell]; }),
             "J/m");
  }
  addArea(scene, "keep-out", rgb(0x000000), blocks, [&](Cell cell) {
    return has(map.surface().hazards(cell), costmap::Hazard::KeepOut);
  });  // over the others
}

/// Size of the map, such as "4 x 3.00 km, cells of 5 m".
std::string sizeText(const maps::Grid& grid) {
  const double width_m = grid.width * grid.resolution_m;
  const double height_m = grid.height * grid.resolution_m;
  const bool large = std::max(width_m, height_m) >= 2000.0;
  const double unit = large ? 1000.0 : 1.0;
  return fmt::format("{:.4g} x {:.4g} {}, cells of {:.4g} m", width_m / unit, height_m / unit,
                     large ? "km" : "m", grid.resolution_m);
}

std::string frameText(const maps::ElevationMap& map) {
  return map.georeference ? map.georeference->body() + ", " + map.georeference->system().name
                          : "local metres";
}

Scene ground(const maps::ElevationMap& map, const Blocks& blocks, const SceneOptions& options) {
  Scene scene;
  scene.title = options.title;
  scene.subtitle = sizeText(map.grid()) + ", " + frameText(map);
  scene.elevation_m = blocks.mean([&map](Cell cell) { return map.elevation_m[cell]; });
  scene.georeference = map.georeference;
  scene.cells_per_pixel = blocks.factor();
  return scene;
}

/// Slope [deg]. If each cell is drawn: slope of the plane that `talus explain` prints. Otherwise: block mean
/// of the planning slopes.
Raster<float> slope_deg(const costmap::TraversabilityMap& map, const Blocks& blocks) {
  if (blocks.factor() == 1)
    return cli::slope_deg(maps::terrainMetrics(map.elevation().elevation_m, map.surface().footprint(1)));
  const auto version = map.published();
  return blocks.mean([&](Cell cell) {
    if (has(map.surface().hazards(cell), costmap::Hazard::Unknown)) return std::nan("");
    const costmap::CellCode code = version->at(cell);
    return std::atan(std::hypot(code.dzDx(), code.dzDy())) / kDegree;
  });
}

void addSlope(Scene& scene, Raster<float> values) {
  addLayer(scene, "slope", std::move(values), "deg", 2);
  Range& range = scene.layers.back().range;
  range = {0.0, std::max(1.0, range.high)};
}

/// A quantity of a route that is compared with that of another route.
struct Quantity {
  const char* name;
  double (*of)(const planner::Route& route);
  std::string (*text)(double value);
};

template <terramech::Category category>
double share(const planner::Route& route) {
  return categoryShares(route)[static_cast<std::size_t>(category)];
}

std::string percentText(double part) {
  return fmt::format("{:.1f} %", 100.0 * part);
}

using planner::Route;
using planner::RouteVertex;
using terramech::Category;
constexpr Quantity kQuantities[] = {
    {"length", [](const Route& r) { return r.length_m; }, lengthText},
    {"driving time", [](const Route& r) { return r.time_s; }, durationText},
    {"energy", [](const Route& r) { return r.energy_J; }, energyText},
    {"cost with time, risk", [](const Route& r) { return r.cost; }, energyText},
    {"max slip", [](const Route& r) { return r.max_slip; },
     [](double slip) { return fmt::format("{:.2f}", slip); }},
    {"max slope", [](const Route& r) { return std::max(r.max_slope_rad, r.max_slope_across_rad); },
     [](double slope_rad) { return fmt::format("{:.1f} deg", slope_rad / kDegree); }},
    {"immobilisation", [](const Route& r) { return r.vertices.back().immobilisation_risk; },
     [](double probability) { return fmt::format("{:.2g}", probability); }},
    {"safe", share<Category::Safe>, percentText},
    {"marginal", share<Category::Marginal>, percentText},
    {"dangerous", share<Category::Dangerous>, percentText},
};

/// The value of a route, followed by its difference to that of the first route.
std::string besideText(const Quantity& quantity, double value, double first) {
  const std::string text = quantity.text(value);
  if (!std::isfinite(value) || !std::isfinite(first) || text == quantity.text(first)) return text;
  return fmt::format("{} ({}{})", text, value < first ? "-" : "+", quantity.text(std::abs(value - first)));
}

/// Rows of the quantities and of the provenance of the routes. Several values of one name in a route, such as files,
/// are joined.
std::vector<ComparedFact> rowsOf(const std::vector<NamedRoute>& routes) {
  std::vector<ComparedFact> rows;
  for (const Quantity& quantity : kQuantities) {
    rows.push_back({quantity.name, {}});
    for (const NamedRoute& one : routes)
      rows.back().values.push_back(
          besideText(quantity, quantity.of(one.route), quantity.of(routes.front().route)));
  }
  for (std::size_t i = 0; i < routes.size(); ++i)
    for (const auto& [name, value] : routes[i].provenance) {
      auto row = std::ranges::find(rows, name, &ComparedFact::name);
      if (row == rows.end()) row = rows.insert(rows.end(), {name, std::vector<std::string>(routes.size())});
      row->values[i] += (row->values[i].empty() ? "" : "; ") + value;
    }
  return rows;
}

/// Index of the vertex nearest to a place, and its distance.
std::pair<std::size_t, double> nearestVertex(const Route& route, const RouteVertex& place) {
  std::pair<std::size_t, double> best{0, INFINITY};
  for (std::size_t i = 0; i < route.vertices.size(); ++i) {
    const RouteVertex& v = route.vertices[i];
    if (const double d = std::hypot(v.x_m - place.x_m, v.y_m - place.y_m); d < best.second) best = {i, d};
  }
  return best;
}

/// Length, time and energy of a route between two vertices.
std::string stretchText(const Route& route, std::size_t from, std::size_t to) {
  const std::vector<double> s = distances_m(route);
  const RouteVertex &a = route.vertices[std::min(from, to)], &b = route.vertices[std::max(from, to)];
  return fmt::format("{}, {}, {}", lengthText(std::abs(s[to] - s[from])), durationText(b.time_s - a.time_s),
                     energyText(b.energy_J - a.energy_J));
}

/// Adds a row and a numbered mark for each stretch on which the second route is more than `apart_m` from the
/// vertices of the first.
void addStretches(Scene& scene, const std::vector<NamedRoute>& routes, double apart_m) {
  constexpr const char* kMarks[] = {"1", "2", "3", "4", "5", "6", "7", "8", "9"};
  const Route &first = routes[0].route, &second = routes[1].route;
  const std::vector<double> s = distances_m(first);
  const auto isApart = [&](std::size_t i) {
    return nearestVertex(second, first.vertices[i]).second > apart_m;
  };
  for (std::size_t i = 0; i < s.size() && scene.marks.size() < std::size(kMarks); ++i) {
    if (!isApart(i)) continue;
    const std::size_t begin = i == 0 ? 0 : i - 1;
    while (i + 1 < s.size() && isApart(i)) ++i;
    const RouteVertex& middle = first.vertices[(begin + i) / 2];
    const char* mark = kMarks[scene.marks.size()];
    scene.marks.emplace_back(mark, maps::Point{middle.x_m, middle.y_m});
    std::vector<std::string> values(routes.size());
    values[0] = stretchText(first, begin, i);
    values[1] = stretchText(second, nearestVertex(second, first.vertices[begin]).first,
                            nearestVertex(second, first.vertices[i]).first);
    scene.comparison.push_back(
        {fmt::format("{}: {:.0f} to {:.0f} m", mark, s[begin], s[i]), std::move(values)});
  }
}

constexpr double kSmall = 0.15;  // of the map's diagonal: sets smaller than this share are marked

/// Number of places, and their bounding rectangle and circle.
struct Extent {
  std::size_t count = 0;
  double west = INFINITY, east = -INFINITY, south = INFINITY, north = -INFINITY;

  void add(maps::Point p) {
    ++count;
    west = std::min(west, p.x_m);
    east = std::max(east, p.x_m);
    south = std::min(south, p.y_m);
    north = std::max(north, p.y_m);
  }
  maps::Point centre() const { return {0.5 * (west + east), 0.5 * (south + north)}; }
  double radius_m() const { return 0.5 * std::hypot(east - west, north - south); }
};

}  // namespace

std::vector<double> quantiles(const Raster<float>& values, const std::vector<double>& shares) {
  std::vector<float> finite;
  for (const float v : values.values())
    if (std::isfinite(v)) finite.push_back(v);
  std::vector<double> out;
  for (const double share : shares) {
    if (finite.empty()) {
      out.push_back(std::nan(""));
      continue;
    }
    const auto at = finite.begin() + std::lround(share * static_cast<double>(finite.size() - 1));
    std::nth_element(finite.begin(), at, finite.end());
    out.push_back(static_cast<double>(*at));
  }
  return out;
}

Raster<float> slope_deg(const maps::TerrainMetrics& metrics) {
  Raster<float> out(metrics.dz_dx.grid());
  costmap::forEachCell(costmap::allOf(out.grid()),
                       [&](Cell cell) { out[cell] = metrics.slope_rad(cell) / static_cast<float>(kDegree); });
  return out;
}

Scene sceneOf(const maps::ElevationMap& map, const SceneOptions& options) {
  const Blocks blocks(map.grid(), options.max_side);
  Scene scene = ground(map, blocks, options);
  addSlope(scene, slope_deg(maps::terrainMetrics(scene.elevation_m, {})));
  addLayer(scene, "elevation", scene.elevation_m, "m", 2);
  return scene;
}

Scene sceneOf(const costmap::TraversabilityMap& map, const SceneOptions& options) {
  const Blocks blocks(map.grid(), options.max_side);
  Scene scene = ground(map.elevation(), blocks, options);
  BlockBeliefs beliefs = beliefsOf(map, blocks);
  scene.headings = std::move(beliefs.headings);
  scene.costs = headingCosts(map, blocks);
  addSlope(scene, slope_deg(map, blocks));
  addLayer(scene, "DP/W (drawbar pull / load)", std::move(beliefs.pull));
  addLayer(scene, "DP/W standard deviation", std::move(beliefs.pull_std));
  addLayer(scene, "z/r (sinkage / wheel radius)", std::move(beliefs.sinkage));
  addMissionLayers(scene, map, blocks);
  addLayer(scene, "elevation", scene.elevation_m, "m", 2);
  scene.facts.emplace_back("rover", map.model().rover().name);
  scene.facts.emplace_back("soil", listText(map.model().parts().classes,
                                            [](const costmap::GroundClass& one) { return one.soil.name; }));
  return scene;
}

Scene sceneOf(const planner::Route& route, const SceneOptions& options) {
  Extent all;
  for (const planner::RouteVertex& v : route.vertices) all.add({v.x_m, v.y_m});
  constexpr int kCells = 100;
  const double side_m = 1.2 * std::max({all.east - all.west, all.north - all.south, 1.0});
  const maps::Point corner{all.centre().x_m - 0.5 * side_m, all.centre().y_m - 0.5 * side_m};
  Scene scene;
  scene.title = options.title;
  scene.subtitle = "route without map: the map was not found";
  scene.elevation_m = Raster<float>({kCells, kCells, side_m / kCells, corner}, std::nanf(""));
  addRoute(scene, route);
  return scene;
}

Raster<std::uint32_t> groundPicture(const std::string& path, const std::optional<maps::Georeference>& place,
                                    const maps::Grid& grid) {
  if (path.empty()) return {};
  constexpr int kSide = 1024;
  const int parts = std::max(1, kSide / std::max(grid.width, grid.height));
  return maps::readImage(
      path, place, {parts * grid.width, parts * grid.height, grid.resolution_m / parts, grid.south_west});
}

std::array<double, 4> sharesOf(const Raster<HeadingShares>& headings) {
  std::array<double, 4> shares{};
  for (const HeadingShares& cell : headings.values())
    for (std::size_t i = 0; i < shares.size(); ++i) shares[i] += cell.count[i];
  const double total = std::max(1.0, std::accumulate(shares.begin(), shares.end(), 0.0));
  for (double& share : shares) share /= total;
  return shares;
}

void addGroundFacts(Scene& scene) {
  std::string headings;
  if (!scene.headings.empty())
    for (std::size_t i = 0; const double share : sharesOf(scene.headings))
      headings += fmt::format("{}{} {}", i == 0 ? "" : ", ", kAllowedNames[i], percentText(share)), ++i;
  if (!headings.empty()) scene.facts.emplace_back("allowed headings", headings);
  for (const ValueLayer& layer : scene.layers) {
    const std::vector<double> at = quantiles(layer.values, {0.1, 0.5, 0.9});
    if (!std::isnan(at[1]))
      scene.facts.emplace_back(
          layer.name, fmt::format("median {:.3g}, 80 % of the cells {:.3g} to {:.3g}{}{}", at[1], at[0],
                                  at[2], layer.unit.empty() ? "" : " ", layer.unit));
  }
}

void addRoute(Scene& scene, const planner::Route& route) {
  scene.route = route;
  for (Fact& fact : summaryOf(route)) scene.facts.push_back(std::move(fact));
  if (const auto warning = warningOf(route)) scene.rings.push_back({warning->place, 0.0, "warning"});
}

void compare(Scene& scene, std::vector<NamedRoute> routes) {
  for (ComparedFact& row : rowsOf(routes))
    if (std::ranges::count(row.values, row.values.front()) == std::ssize(row.values))
      scene.facts.emplace_back(row.name, row.values.front());
    else
      scene.comparison.push_back(std::move(row));
  addStretches(scene, routes, 3.0 * scene.grid().resolution_m);
  scene.route = routes.front().route;
  scene.routes = std::move(routes);
}

Scene reachScene(const maps::ElevationMap& map, const costmap::CostGrid& cost, const Severed& severed,
                 const SceneOptions& options) {
  Scene scene = sceneOf(map, options);
  planner::HeadingSets headings(cost.cost());
  const Reach from(cost, headings, Reach::Sense::From, severed.places.from);
  const Reach to(cost, headings, Reach::Sense::To, severed.places.to, severed.tolerance_m);
  ValueLayer layer{.name = "two sets that nothing connects",
                   .unit = "",
                   .values = maps::Raster<float>(scene.grid(), std::nanf("")),
                   .range = {0.0, 1.0},
                   .decimals = 0};
  Extent reached, leading;
  costmap::forEachCell(costmap::allOf(scene.grid()), [&](Cell pixel) {
    const maps::Point centre = scene.grid().centre(pixel);
    const auto cell = cost.grid().cellAt(centre);
    if (!cell) return;
    if (from.holds(*cell)) {
      layer.values[pixel] = 0.0F;
      reached.add(centre);
    } else if (to.holds(*cell)) {
      layer.values[pixel] = 1.0F;
      leading.add(centre);
    }
  });
  const std::string first = fmt::format("reached from the start: {} cells", reached.count);
  const std::string second = fmt::format("leading to the goal: {} cells", leading.count);
  layer.classes = {{first, seriesColour(0)}, {second, seriesColour(4)}};
  const bool start_is_small = reached.count <= leading.count;
  const Extent& small = start_is_small ? reached : leading;
  const maps::Grid& grid = scene.grid();
  if (small.count > 0 && small.radius_m() < kSmall * std::hypot(grid.width, grid.height) * grid.resolution_m)
    scene.rings.push_back({small.centre(), small.radius_m(), start_is_small ? first : second});
  scene.layers.insert(scene.layers.begin(), std::move(layer));
  scene.title += ": " + severed.reason;
  scene.facts.emplace_back("route", "no_route: " + severed.reason);
  scene.marks = {{"S", severed.places.from}, {"G", severed.places.to}};
  return scene;
}

}  // namespace talus::cli
