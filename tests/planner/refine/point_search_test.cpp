#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <talus/planner/refine/point_search.hpp>

#include "drawn_map.hpp"

namespace talus::planner {

namespace point_search_test {

using costmap::CellCode;

std::vector<CellCode> randomCells() {
  std::mt19937 random(8);
  std::vector<CellCode> cells;
  const auto gradient = [&random] { return (static_cast<int>(random() % 700) - 350) / 1024.0; };
  for (int k = 0; k < 400; ++k)
    cells.push_back(CellCode(
        {.dz_dx = gradient(), .dz_dy = gradient(), .curve = static_cast<std::uint8_t>(random() % 5)}));
  return cells;
}

// Property: a cell below the gentle gradient of its curve allows every heading; most cells that allow every
// heading are below it.
TEST(GentleGradient, CellsBelowItAllowEveryHeading) {
  const auto cost = testing::driveCost({.max_along = 0.3, .max_across = 0.25});
  int free = 0, all = 0;
  for (const CellCode cell : randomCells()) {
    bool every = true;
    for (int d = 0; d < 720; ++d)
      every = every && std::isfinite(cost->costPerMetre(cell, {std::cos(d * std::numbers::pi / 360),
                                                               std::sin(d * std::numbers::pi / 360)}));
    const bool gentle =
        std::hypot(cell.dzDx(), cell.dzDy()) < gentleGradient(*cost, cost->curves()[cell.curve()]);
    EXPECT_TRUE(every || !gentle);
    free += gentle;
    all += every;
  }
  EXPECT_GT(free, 50);
  EXPECT_GT(free, 0.9 * all);
}

using maps::Point;
using testing::drawn;
using testing::randomMap;

PointPath searchNear(const MotionCost& cost, const Polyline& along, double below_J, int reach_cells,
                     int points_per_side = 3) {
  return PointSearch(cost, {.side = points_per_side})(
      {.places = {along.front(), along.back()}, .below_J = below_J},
      SearchRegion(cost.map().grid(), along, reach_cells));
}

double priced(const MotionCost& cost, const PointPath& path) {
  const Polyline& points = path.points;
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += cost({points[i - 1], points[i]});
  return sum;
}

// Property: after turns are shifted along their edges, both adjacent cells allow both headings.
TEST(PointPath, ShiftedTurnsAreValid) {
  int slid = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const MotionCost cost(
        randomMap({.width = 30, .height = 30, .seed = seed, .blocked = 0.05, .roughness = 0.25}));
    PointPath path = searchNear(cost, {{1.5, 1.5}, {28.3, 27.1}}, 1e9, 30);
    if (path.points.empty()) continue;
    ++slid;
    const double before = cost.along(path.points);
    slideTurns(cost.map(), path, 0.5 / 3, 4);
    EXPECT_LE(cost.along(path.points), before) << seed;
  }
  EXPECT_GT(slid, 10);
}

// Property: shifting never increases the cost, keeps ends and cells, and yields refraction by Snell's law.
TEST(PointPath, ShiftingReducesCostAndKeepsEndsAndCells) {
  std::vector<std::string> rows(40, std::string(40, '.'));
  for (auto& row : rows) row.replace(20, 20, std::string(20, '2'));
  const MotionCost cost(drawn(rows));
  const Point from{3.5, 5.5}, to{36.5, 30.5};
  PointPath path = searchNear(cost, {from, to}, 1e9, 8, 3);
  const double before = priced(cost, path);
  const auto cells = path.cells;
  slideTurns(cost.map(), path, 0.5 / 3, 6);
  double best = 1e9;  // Closed form, by scanning where the border is crossed.
  for (double y = 5.5; y < 30.5; y += 1e-3)
    best = std::min(best,
                    10 * std::hypot(20 - from.x_m, y - from.y_m) + 30 * std::hypot(to.x_m - 20, to.y_m - y));
  const double after = priced(cost, path);
  EXPECT_LT(after, before);
  EXPECT_EQ(path.cells, cells);
  EXPECT_EQ(path.points.front(), from);
  EXPECT_EQ(path.points.back(), to);
  EXPECT_GE(after, best * (1 - 1e-9));
  EXPECT_LT(after, best * 1.01);
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Whether every cell that touches a point on an edge allows the heading of a motion.
bool mayTurn(const MotionCost& cost, Point from, Point to, Point turn) {
  const double length = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
  const costmap::Direction heading{(to.x_m - from.x_m) / length, (to.y_m - from.y_m) / length};
  for (const double dx : {-1e-3, 1e-3})
    for (const double dy : {-1e-3, 1e-3})
      if (const auto cell = cost.map().grid().cellAt({turn.x_m + dx, turn.y_m + dy}))
        if (std::isinf(cost.map().cost().costPerMetre(cost.map().at(*cell), heading))) return false;
  return true;
}

// The cheapest path over the points of all edges, by relaxing every pair of points of a cell until no cost
// decreases; an independent computation of the expected result.
struct ByHand {
  double cost_J = kInfinity;
  bool bounces = false;  // at an edge, back into the same cell
};

ByHand cheapestByHand(const MotionCost& cost, Point from, Point to, int points) {
  const maps::Grid& grid = cost.map().grid();
  std::vector<Point> places{from, to};
  for (int line = 0; line <= grid.width; ++line)
    for (int row = 0; row < grid.height; ++row)
      for (int k = 0; k < points; ++k) places.push_back({line * 1.0, row + (k + 0.5) / points});
  for (int line = 0; line <= grid.height; ++line)
    for (int column = 0; column < grid.width; ++column)
      for (int k = 0; k < points; ++k) places.push_back({column + (k + 0.5) / points, line * 1.0});
  const auto shareACell = [](Point a, Point b) {
    const double x = 0.5 * (a.x_m + b.x_m), y = 0.5 * (a.y_m + b.y_m);
    if ((a.x_m == b.x_m && a.x_m == std::round(a.x_m)) || (a.y_m == b.y_m && a.y_m == std::round(a.y_m)))
      return false;
    for (const Point p : {a, b})
      if (std::abs(p.x_m - std::floor(x) - 0.5) > 0.5 || std::abs(p.y_m - std::floor(y) - 0.5) > 0.5)
        return false;
    return true;
  };
  const auto turns = [&](std::size_t a, std::size_t b) {
    return (a < 2 || mayTurn(cost, places[a], places[b], places[a])) &&
           (b < 2 || mayTurn(cost, places[a], places[b], places[b]));
  };
  std::vector<double> label(places.size(), kInfinity);
  std::vector<std::size_t> before(places.size(), 0);
  label[0] = 0.0;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t a = 0; a < places.size(); ++a)
      for (std::size_t b = 0; b < places.size() && std::isfinite(label[a]); ++b) {
        if (a == b || !shareACell(places[a], places[b])) continue;
        const double through = label[a] + cost({places[a], places[b]});
        if (through < label[b] - 1e-12 && turns(a, b)) label[b] = through, before[b] = a, changed = true;
      }
  }
  ByHand found{label[1]};
  const auto cellOf = [&](std::size_t place) {  // cell of the motion that ends at the point
    const Point a = places[before[place]], b = places[place];
    return grid.cellAt({0.5 * (a.x_m + b.x_m), 0.5 * (a.y_m + b.y_m)});
  };
  for (std::size_t at = 1; std::isfinite(found.cost_J) && before[at] != 0; at = before[at])
    found.bounces = found.bounces || cellOf(at) == cellOf(before[at]);
  return found;
}

TEST(PointSearch, FindsTheCheapestPathOverEdgePoints) {
  int same = 0, bouncing = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const MotionCost cost(
        randomMap({.width = 6, .height = 5, .seed = seed, .blocked = 0.1, .roughness = 0.06 * (seed % 6)}));
    const Point from{0.6, 0.7}, to{5.3, 4.4};
    const ByHand expected = cheapestByHand(cost, from, to, 2);
    const PointPath path = searchNear(cost, {from, to}, 1e9, 6, 2);
    bouncing += expected.bounces;
    if (path.points.empty()) {
      EXPECT_TRUE(expected.bounces || std::isinf(expected.cost_J)) << seed;
      continue;
    }
    EXPECT_TRUE(std::isfinite(cost.along(path.points))) << seed;          // turns on edges, too
    EXPECT_GE(priced(cost, path), expected.cost_J * (1 - 1e-5)) << seed;  // labels are floats
    if (!expected.bounces) {
      EXPECT_NEAR(priced(cost, path), expected.cost_J, 1e-5 * expected.cost_J) << seed;
      ++same;
    }
    // Property: no path is returned if none is cheaper than the given cost.
    EXPECT_TRUE(searchNear(cost, {from, to}, 0.999 * expected.cost_J, 6, 2).points.empty());
  }
  EXPECT_GT(same, 15);
  EXPECT_GT(bouncing, 0);
}

// Ends on edges and corners, at the map's border, with zero reach: the search includes the cells that touch
// the ends.
TEST(PointSearch, EndsMayLieOnMapEdges) {
  const MotionCost cost(drawn(std::vector<std::string>(6, std::string(7, '.'))));
  for (const Point from : {Point{0.0, 2.0}, Point{3.0, 0.0}, Point{0.0, 0.0}, Point{7.0, 6.0}})
    for (const Point to : {Point{5.0, 4.0}, Point{7.0, 3.0}, Point{2.0, 6.0}, Point{4.5, 6.0}}) {
      const PointPath path = searchNear(cost, {from, to}, 1e9, 0, 3);
      if (path.points.empty()) continue;
      EXPECT_GE(priced(cost, path), 10.0 * std::hypot(to.x_m - from.x_m, to.y_m - from.y_m) * (1 - 1e-6));
    }
}

TEST(PointSearch, PathStaysWithinReachOfTheRoute) {
  std::vector<std::string> rows(20, std::string(20, '4'));
  rows.front() = rows.back() = std::string(20, '.');  // cheap, but out of reach
  const MotionCost cost(drawn(rows));
  const PointPath path = searchNear(cost, {{1.5, 10.5}, {18.5, 10.5}}, 1e9, 2);
  ASSERT_FALSE(path.points.empty());
  for (const maps::Cell cell : path.cells) EXPECT_LE(std::abs(cell.row - 10), 2);
}

}  // namespace point_search_test

}  // namespace talus::planner
