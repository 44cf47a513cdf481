// Exact optima of small maps by linear programmes, which CLP solves: routes and lower bounds are compared with
// optima that share no search with the planner.
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <ClpSimplex.hpp>
#include <CoinPackedMatrix.hpp>
#include <site_fixture.hpp>

#include <talus/maps/sites/site_generator.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/bound/sub_solution.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/grid/point_route.hpp>
#include <talus/planner/refine/point_search.hpp>
#include <talus/planner/refine/vertices.hpp>
#include <talus/planner/site/site.hpp>

#include "drawn_map.hpp"
#include "jagged_cost.hpp"

namespace talus::planner {
namespace linear_oracle_test {

using MapPointer = std::shared_ptr<const costmap::CostGrid>;

// Variable of a linear programme, >= 0: the cost of a unit, and what a unit adds to rows.
struct Column {
  double cost;
  std::vector<std::pair<int, double>> adds;
};

// Returns the minimum of the total cost such that the sums of the rows are `sums`; infinite if there is none.
double minimum(const std::vector<double>& sums, const std::vector<Column>& columns) {
  std::vector<int> rows, starts{0};
  std::vector<double> elements, costs;
  for (const Column& column : columns) {
    costs.push_back(column.cost);
    for (const auto& [row, value] : column.adds) rows.push_back(row), elements.push_back(value);
    starts.push_back(static_cast<int>(rows.size()));
  }
  ClpSimplex programme;
  programme.setLogLevel(0);
  programme.loadProblem(static_cast<int>(columns.size()), static_cast<int>(sums.size()), starts.data(),
                        rows.data(), elements.data(), nullptr, nullptr, costs.data(), sums.data(),
                        sums.data());
  programme.dual();
  return programme.isProvenOptimal() ? programme.objectiveValue() : kInfinity;
}

costmap::Direction heading(int k, int of) {
  return {std::cos(2.0 * std::numbers::pi * k / of), std::sin(2.0 * std::numbers::pi * k / of)};
}

double perMetre(const costmap::CostGrid& map, maps::Cell cell, const costmap::Direction& d) {
  return static_cast<double>(map.cost().costPerMetre(map.at(cell), d));
}

// The cheapest flow of one unit over the graph of `points` points on each side of a cell, whose edges cross one
// cell in a heading that every cell at their ends allows: the cost of an allowed route without turns.
double cheapestOverPoints_J(const costmap::CostGrid& map, const Segment& places, int points) {
  const maps::Grid& grid = map.grid();
  std::vector<std::vector<int>> points_of(grid.size());
  std::vector<maps::Point> at{places.from, places.to};
  std::vector<std::vector<maps::Cell>> cells_of{{*grid.cellAt(places.from)}, {*grid.cellAt(places.to)}};
  const auto addSide = [&](maps::Cell a, maps::Cell b) {
    if (!grid.contains(b)) return;
    const maps::Point from = grid.centre(a), to = grid.centre(b);
    for (int k = 0; k < points; ++k) {
      const double off = (k + 0.5) / points - 0.5;
      at.push_back({0.5 * (from.x_m + to.x_m) + off * (to.y_m - from.y_m),
                    0.5 * (from.y_m + to.y_m) + off * (to.x_m - from.x_m)});
      cells_of.push_back({a, b});
    }
  };
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      addSide({column, row}, {column + 1, row});
      addSide({column, row}, {column, row + 1});
    }
  for (std::size_t n = 0; n < at.size(); ++n)
    for (const maps::Cell cell : cells_of[n]) points_of[grid.index(cell)].push_back(static_cast<int>(n));
  std::vector<Column> edges;
  for (std::size_t cell = 0; cell < points_of.size(); ++cell)
    for (const int a : points_of[cell])
      for (const int b : points_of[cell]) {
        const auto from = static_cast<std::size_t>(a), to = static_cast<std::size_t>(b);
        const Segment leg{at[from], at[to]};
        if (a == b || (a > 1 && b > 1 && cells_of[from] == cells_of[to])) continue;
        const costmap::Direction d = directionOf(leg);
        double each_J = 0.0;
        for (const std::size_t end : {from, to})
          for (const maps::Cell beside : cells_of[end])
            if (std::isinf(perMetre(map, beside, d))) each_J = kInfinity;
        each_J +=
            distance_m(leg.from, leg.to) *
            perMetre(map, {static_cast<int>(cell) % grid.width, static_cast<int>(cell) / grid.width}, d);
        if (std::isfinite(each_J)) edges.push_back({each_J, {{a, 1.0}, {b, -1.0}}});
      }
  std::vector<double> sums(at.size());
  sums[0] = 1.0, sums[1] = -1.0;
  return minimum(sums, edges);
}

// An end of a route, between the centre of a cell and one of its corners, with the shares of both.
struct End {
  maps::Cell cell;
  std::size_t corner;
  static constexpr double kShare = 0.3;
  maps::Point in(const maps::Grid& grid) const {
    const maps::Point middle = grid.centre(cell);
    const double off_m = 0.5 * kShare * grid.resolution_m;
    return {middle.x_m + (corner % 3 == 0 ? -off_m : off_m), middle.y_m + (corner < 2 ? -off_m : off_m)};
  }
};

// The cheapest flow of one unit over the mesh of four triangles for each cell, in 64 headings, where a metre costs
// the limit of the heading. By duality this is the greatest bound by a function that is linear on each triangle.
double greatestCertificate_J(const costmap::CostGrid& map, const End& start, const End& goal) {
  const maps::Grid& grid = map.grid();
  const CellMesh mesh(grid);
  DirectionalCostBounds bounds(map.cost());
  std::vector<double> sums(mesh.corners() + grid.size());
  for (const auto& [end, sign] : {std::pair{start, 1.0}, std::pair{goal, -1.0}}) {
    sums[mesh.nodesOf(end.cell)[CellMesh::kMiddle]] += sign * (1.0 - End::kShare);
    sums[mesh.nodesOf(end.cell)[end.corner]] += sign * End::kShare;
  }
  std::vector<Column> flows;
  for (int cell = 0; cell < static_cast<int>(grid.size()); ++cell) {
    const maps::Cell at{cell % grid.width, cell / grid.width};
    const CellMesh::Nodes nodes = mesh.nodesOf(at);
    DirectionalCostBounds::Limits limits;
    if (!bounds.of(map.at(at), limits)) continue;
    for (int h = 0; h < DirectionalCostBounds::kHeadings; ++h)
      for (std::size_t k = 0; k < 4; ++k) {
        const costmap::Direction d = heading(h, DirectionalCostBounds::kHeadings),
                                 side = heading(static_cast<int>(k), 4);
        const double on = d.x * side.x + d.y * side.y, in = d.y * side.x - d.x * side.y;
        flows.push_back({grid.resolution_m * static_cast<double>(limits[static_cast<std::size_t>(h)]),
                         {{static_cast<int>(nodes[k]), on + in},
                          {static_cast<int>(nodes[CellMesh::next(k)]), in - on},
                          {static_cast<int>(nodes[CellMesh::kMiddle]), -2.0 * in}}});
      }
  }
  return minimum(sums, flows);
}

// The bound of a SubSolution on the whole map, whose search takes at most `quota` nodes and checks.
double certified_J(const MapPointer& map, const Segment& places, std::size_t quota = ~std::size_t{0}) {
  FittedOctagons octagons(map->cost());
  DirectionalCostBounds limits(map->cost());
  std::vector<FieldGoal> corners;
  const maps::Cell start = *map->grid().cellAt(places.from);
  for (const int row : {start.row, start.row + 1})
    for (const int column : {start.column, start.column + 1}) corners.push_back({{column, row}, 0.0});
  const SubSolution::Parts parts{.map = map,
                                 .places = places,
                                 .most_J = kInfinity,
                                 .cheapest_J = cheapestMetre_J(*map),
                                 .from_start = cornerField(
                                     map, [&](maps::Cell cell) { return octagons.of(map->at(cell)); },
                                     corners, {}, RouteSense::FromStart)};
  return provenBy(SubSolution(parts, limits, quota, {}), parts).bound_J;
}

// Costs without turns of the cells of elevations, of two soils.
MapPointer costsOf(maps::ElevationMap elevation, maps::Raster<std::uint8_t> classes) {
  costmap::MapLayers layers;
  layers.elevation = std::move(elevation);
  for (auto& number : classes.values()) number = number < 3 ? 1 : 2;
  layers.classes = std::move(classes);
  return testing::withTurns(
      costmap::TraversabilityMap(std::move(layers), costmap::testGround(), {}).published(), 0.0);
}

// Cells of a map around a random place, `side` columns and rows.
MapPointer crop(const costmap::CostGrid& map, int side, std::mt19937& random) {
  const auto below = [&](int most) { return static_cast<int>(random() % static_cast<unsigned>(most + 1)); };
  const maps::Cell first{below(map.grid().width - side), below(map.grid().height - side)};
  maps::Raster<costmap::CellCode> cells(
      {.width = side, .height = side, .resolution_m = map.grid().resolution_m, .south_west = {-7.0, 3.0}});
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      cells[{column, row}] = map.at({first.column + column, first.row + row});
  return std::make_shared<costmap::CostGrid>(
      costmap::flattened(cells, std::make_shared<costmap::TravelCost>(map.cost())));
}

// Maps to crop: generated sites, uncorrelated cells with costs of two kinds, and the real maps.
std::vector<MapPointer> grounds() {
  std::vector<MapPointer> all;
  for (const auto kind : {maps::SiteKind::Craters, maps::SiteKind::Dunes, maps::SiteKind::Rocks}) {
    const auto site = maps::generateSite({.kind = kind, .width = 96, .height = 96, .seed = 7});
    all.push_back(costsOf(site.map, site.classes));
  }
  for (const auto& cost : {testing::driveCost(), testing::jaggedCost()}) {
    costmap::CostGrid::Content content =
        testing::randomMap(
            {.width = 96, .height = 96, .blocked = 0.1, .roughness = 0.15, .resolution_m = 2.0})
            ->content();
    content.cost = cost;
    all.push_back(std::make_shared<costmap::CostGrid>(std::move(content)));
  }
  if (const char* real = std::getenv("TALUS_REAL_MAPS"))
    for (const auto& [file, window] :
         {std::pair{"mars_gale_hirise_1m.tif", "8142450,-276750,8142550,-276650"},
          std::pair{"moon_lola_npc_2km_5m.tif", "127000,-93000,127500,-92500"}}) {
      ElevationFile part(std::string(real) + "/" + file);
      part.window = window;
      const maps::ElevationMap map = readMap(part);
      all.push_back(costsOf(map, maps::Raster<std::uint8_t>(map.elevation_m.grid(), 1)));
    }
  return all;
}

// Property: the planned route costs at most the cheapest flow over 5 or 2 points a side, and no less than the greatest
// certificate; every bound, also for any known cost and of a search that ends early, is below both; the search for
// the certificate reaches 91 % of the greatest one on average (0.70 to 0.995).
TEST(LinearOracle, RouteAndBoundEncloseTheOptimum) {
  int found = 0;
  double share = 0.0, certificates = 0.0;
  for (const MapPointer& ground : grounds()) {
    std::mt19937 random(11);
    for (const int side : {12, 12, 12, 16, 40}) {
      const MapPointer map = crop(*ground, side, random);
      const auto below = [&] { return static_cast<int>(random() % static_cast<unsigned>(side)); };
      const End start{{below(), below()}, 0}, goal{{below(), below()}, 2};
      const Segment ends{start.in(map->grid()), goal.in(map->grid())};
      const double graph_J = cheapestOverPoints_J(*map, ends, side < 16 ? 5 : 2);
      if (!std::isfinite(graph_J)) continue;
      ++found;
      Problem problem{.map = map, .start = ends.from, .goal = ends.to};
      problem.prove = true;
      const Plan plan = FieldPlanner().plan(problem);
      EXPECT_LE(plan.cost_J, graph_J) << found;
      EXPECT_NEAR(plan.cost_J, MotionCost(map).along(plan.points), 1e-9 * plan.cost_J) << found;
      EXPECT_TRUE(violations(*map, plan.points).empty()) << found;
      EXPECT_LE(plan.lower_bound_J, plan.cost_J) << found;
      const double whole_J = LowerBound()(map, ends, 0.0);
      for (const double known_J :
           {1.01 * whole_J, 1.1 * whole_J, plan.cost_J, 2.0 * plan.cost_J, kInfinity}) {
        EXPECT_LE(LowerBound()(map, ends, 0.0, {}, known_J), std::min(known_J, plan.cost_J)) << found;
        EXPECT_LE(straightBoundOver_J(*map, ends, 0.0, known_J), (1.0 + 1e-9) * plan.cost_J) << found;
      }
      for (const std::size_t quota : {std::size_t{50}, std::size_t{300}, std::size_t{1500}})
        EXPECT_LE(certified_J(map, ends, quota), plan.cost_J) << found << ' ' << quota;
      if (side == 40) continue;
      const double most_J = greatestCertificate_J(*map, start, goal), certified = certified_J(map, ends);
      EXPECT_LE(most_J, plan.cost_J) << found;
      EXPECT_LE(certified, (1.0 + 1e-5) * most_J) << found;  // values are floats
      ++certificates;
      share += certified / most_J;
    }
  }
  EXPECT_GT(found, 15);
  EXPECT_GT(share / certificates, 0.85);
}

// Property: on a plane, whose cost is uniform but depends on the heading, the best drive, a mixture of 720 headings
// and the direct one, costs at least the bound and at most half a percent more.
TEST(LinearOracle, BoundIsTightOnPlanes) {
  std::mt19937 random(11);
  const auto place = [&random] { return 0.1 * static_cast<double>(random() % 600); };
  for (int n = 0; n < 12; ++n) {
    const auto gradient = [&] { return (static_cast<int>(random() % 200) - 100) / 1024.0; };
    const maps::Raster<costmap::CellCode> cells(
        {.width = 60, .height = 60, .resolution_m = 1.0, .south_west = {}},
        costmap::CellCode({.dz_dx = gradient(), .dz_dy = gradient(), .curve = 2}));
    const auto map = std::make_shared<costmap::CostGrid>(costmap::flattened(cells, testing::driveCost()));
    const Segment ends{{place(), place()}, {place(), place()}};
    if (distance_m(ends.from, ends.to) < 20.0) continue;
    std::vector<costmap::Direction> headings{directionOf(ends)};
    for (int k = 0; k < 720; ++k) headings.push_back(heading(k, 720));
    std::vector<Column> metres;
    for (const auto& d : headings)
      if (const double metre_J = perMetre(*map, {0, 0}, d); std::isfinite(metre_J))
        metres.push_back({metre_J, {{0, d.x}, {1, d.y}}});
    const double cost_J = minimum({ends.to.x_m - ends.from.x_m, ends.to.y_m - ends.from.y_m}, metres);
    const double bound_J = LowerBound()(map, ends, 0.0);
    EXPECT_LE(bound_J, cost_J * (1.0 + 1e-9)) << n;
    EXPECT_GE(bound_J, cost_J / 1.005) << n;
  }
}

// Property: the searches over points find a path of at most the cost of the cheapest flow over as many points.
TEST(LinearOracle, PointSearchFindsTheCheapestPath) {
  int found = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const auto map = testing::randomMap(
        {.width = 8, .height = 7, .seed = seed, .blocked = 0.15, .roughness = seed % 2 == 0 ? 0.0 : 0.1});
    const MotionCost cost(map);
    const Segment ends{{0.6, 0.7}, {7.3, 6.4}};
    const double least_J = cheapestOverPoints_J(*map, ends, 3);
    if (!std::isfinite(least_J)) continue;
    ++found;
    const SearchRegion whole(map->grid(), {ends.from, ends.to}, [](maps::Cell) { return 8; });
    const auto pathBelow = [&](double below_J) {
      return PointSearch(cost, {.side = 3})({.places = ends, .below_J = below_J}, whole).points;
    };
    const Polyline path = pathBelow(1e9);
    const double path_J = cost.ofLegs(path);
    EXPECT_TRUE(std::isfinite(cost.along(offSides(cost, path)))) << seed;
    EXPECT_LE(path_J, least_J * (1.0 + 1e-5)) << seed;  // labels are floats
    EXPECT_TRUE(pathBelow(0.999 * path_J).empty()) << seed;
    const Polyline route = pointRoute(cost, ends, 0.0, kInfinity);
    EXPECT_LE(cost.along(route), least_J) << seed;
    EXPECT_TRUE(violations(*map, route).empty()) << seed;
    EXPECT_EQ(route.back(), ends.to) << seed;
    EXPECT_TRUE(pointRoute(cost, ends, 0.0, 0.5 * path_J).empty()) << "nothing half as dear";
  }
  EXPECT_GT(found, 15);
}

}  // namespace linear_oracle_test
}  // namespace talus::planner
