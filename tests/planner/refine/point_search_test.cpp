#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <talus/planner/refine/point_search.hpp>
#include <talus/planner/refine/vertices.hpp>

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
      SearchRegion(cost.map().grid(), along, [&](maps::Cell) { return reach_cells; }));
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

// The cheapest path over the points of all edges, by relaxing every pair of points of a cell until no cost
// decreases; an independent computation of the expected result. The first and the last leg may also lead to
// the points of the adjacent cells.
double cheapestByHand(const MotionCost& cost, Point from, Point to, int points) {
  const maps::Grid& grid = cost.map().grid();
  Polyline places{from, to};
  for (int line = 1; line < grid.width; ++line)
    for (int row = 0; row < grid.height; ++row)
      for (int k = 0; k < points; ++k) places.push_back({line * 1.0, row + (k + 0.5) / points});
  for (int line = 1; line < grid.height; ++line)
    for (int column = 0; column < grid.width; ++column)
      for (int k = 0; k < points; ++k) places.push_back({column + (k + 0.5) / points, line * 1.0});
  const auto join = [&](std::size_t a, std::size_t b) {
    const Point p = places[a], q = places[b];
    const double x = std::floor(0.5 * (p.x_m + q.x_m)), y = std::floor(0.5 * (p.y_m + q.y_m));
    if (a > 1 && b > 1 &&
        ((p.x_m == q.x_m && p.x_m == std::round(p.x_m)) || (p.y_m == q.y_m && p.y_m == std::round(p.y_m))))
      return false;
    const auto inside = [](Point at, double west, double south, double side) {
      return at.x_m >= west && at.y_m >= south && at.x_m <= west + side && at.y_m <= south + side;
    };
    if (a > 1 && b > 1) return inside(p, x, y, 1.0) && inside(q, x, y, 1.0);
    const Point end = a < 2 ? p : q, other = a < 2 ? q : p;
    return inside(other, std::floor(end.x_m) - 1.0, std::floor(end.y_m) - 1.0, 3.0);
  };
  std::vector<double> label(places.size(), kInfinity);
  label[0] = 0.0;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t a = 0; a < places.size(); ++a)
      for (std::size_t b = 1; b < places.size() && a != 1 && std::isfinite(label[a]); ++b) {
        if (a == b || !join(a, b)) continue;
        const double through = label[a] + cost({places[a], places[b]});
        if (through < label[b] - 1e-12) label[b] = through, changed = true;
      }
  }
  return label[1];
}

// Property: where every cell permits all headings or none, the path costs as much as the cheapest path over the
// points of edges; elsewhere, with points inside cells, at most as much, unless a turn is not permitted.
TEST(PointSearch, FindsTheCheapestPathOverEdgePoints) {
  int same = 0, steep = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const MotionCost cost(randomMap(
        {.width = 6, .height = 5, .seed = seed, .blocked = 0.15, .roughness = seed % 2 == 0 ? 0.0 : 0.05}));
    const Point from{0.6, 0.7}, to{5.3, 4.4};
    const double expected_J = cheapestByHand(cost, from, to, 2);
    const PointPath path = searchNear(cost, {from, to}, 1e9, 6, 2);
    ASSERT_EQ(path.points.empty(), std::isinf(expected_J)) << seed;
    if (path.points.empty()) continue;
    const double path_J = cost.ofLegs(path.points);
    if (seed % 2 == 0) {
      EXPECT_NEAR(path_J, expected_J, 1e-5 * expected_J) << seed;  // labels are floats
    } else {
      EXPECT_LE(path_J, expected_J * (1 + 1e-5)) << seed;
    }
    ++(seed % 2 == 0 ? same : steep);
    EXPECT_TRUE(std::isfinite(cost.along(offSides(cost, path.points)))) << seed;
    // Property: no path is returned if none is cheaper than the given cost.
    EXPECT_TRUE(searchNear(cost, {from, to}, 0.999 * path_J, 6, 2).points.empty());
  }
  EXPECT_GT(same, 10);
  EXPECT_GT(steep, 10);
}

// A leg that passes a corner within 1e-5 of a cell touches the blocked cell there.
TEST(MotionCost, LegsCloseToACornerTouchItsCells) {
  const MotionCost cost(drawn({".#", ".."}));
  EXPECT_TRUE(std::isfinite(cost({{0.2, 0.99}, {1.8, 0.98}})));
  EXPECT_TRUE(std::isinf(cost({{0.2, 0.9999985}, {1.8, 0.9999975}})));
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
