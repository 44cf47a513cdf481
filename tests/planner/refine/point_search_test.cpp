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
