#include <cmath>
#include <queue>
#include <random>

#include <gtest/gtest.h>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/reach/cell_chain.hpp>
#include <talus/planner/reach/reach.hpp>

#include "contour_plane.hpp"
#include "drawn_map.hpp"
#include "steered_ground.hpp"

namespace talus::planner {

namespace cell_chain_test {

Polyline routed(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                double tolerance_m = 0.0) {
  const MotionCost cost(map);
  HeadingSets headings(map->cost());
  return cellRoute(cost, headings, places, tolerance_m).points;
}

// Property: on random steep maps every route is allowed, and a route is found in nearly all cases without a
// proof of absence.
TEST(CellRoute, RouteIsValidAndFoundUnlessProvenAbsent) {
  int found = 0, missed = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const auto map =
        testing::randomMap({.width = 9, .height = 9, .seed = seed, .blocked = 0.2, .roughness = 0.38});
    const Segment places{{1.3, 1.4}, {7.6, 7.8}};
    const MotionCost cost(map);
    if (!cost.allowed(places.from) || !cost.allowed(places.to)) continue;
    HeadingSets headings(map->cost());
    Reach reach(*map, headings, Reach::Sense::From, places.from);
    const Polyline way = routed(map, places);
    if (!way.empty()) {
      ++found;
      EXPECT_TRUE(std::isfinite(cost.along(way))) << seed;
      EXPECT_TRUE(violations(*map, way).empty()) << seed;
      EXPECT_TRUE(reach.reaches(places.to, 0.0)) << seed;
    } else if (reach.reaches(places.to, 0.0)) {
      ++missed;
    }
  }
  EXPECT_GT(found, 20);
  EXPECT_LE(missed, 2) << found;
}

// Reachability on a map of nine by nine cells by brute force: every motion by MotionCost between points of a
// lattice, four to a cell's side, at most six points apart.
constexpr int kFine = 4, kSide = 9 * kFine;

maps::Point latticePlace(int k) {
  return {(k % kSide + 0.5) / kFine, (k / kSide + 0.5) / kFine};
}

std::vector<bool> reachedByForce(const MotionCost& cost, int from) {
  std::vector<bool> seen(kSide * kSide, false);
  std::queue<int> open({from});
  seen[static_cast<std::size_t>(from)] = true;
  for (; !open.empty(); open.pop())
    for (int dy = -6; dy <= 6; ++dy)
      for (int dx = -6; dx <= 6; ++dx) {
        const int x = open.front() % kSide + dx, y = open.front() / kSide + dy;
        if (x < 0 || y < 0 || x >= kSide || y >= kSide) continue;
        const int next = y * kSide + x;
        if (seen[static_cast<std::size_t>(next)]) continue;
        if (!std::isfinite(cost({latticePlace(open.front()), latticePlace(next)}))) continue;
        seen[static_cast<std::size_t>(next)] = true;
        open.push(next);
      }
  return seen;
}

struct Answers {
  int found = 0;
  int out_of_reach = 0;  // proven although Reach has no proof
  int neither = 0;
  int wrong = 0;  // an invalid route, or a proof that brute force refutes
};

void ask(const std::shared_ptr<const costmap::CostGrid>& map, unsigned seed, int from, Answers& answers) {
  const MotionCost cost(map);
  if (!cost.allowed(latticePlace(from))) return;
  const std::vector<bool> forced = reachedByForce(cost, from);
  HeadingSets headings(map->cost());
  Reach reach(*map, headings, Reach::Sense::From, latticePlace(from));
  std::mt19937 random(seed);
  for (int k = 0; k < 16; ++k) {
    const int to = static_cast<int>(random() % static_cast<unsigned>(kSide * kSide));
    if (!cost.allowed(latticePlace(to)) || !reach.reaches(latticePlace(to), 0.0)) continue;
    const CellRoute way = cellRoute(cost, headings, {latticePlace(from), latticePlace(to)}, 0.0);
    const bool found = !way.points.empty();
    answers.found += found;
    answers.out_of_reach += way.out_of_reach;
    answers.neither += !found && !way.out_of_reach;
    answers.wrong += found && !violations(*map, way.points).empty();
    answers.wrong += way.out_of_reach && forced[static_cast<std::size_t>(to)];
  }
}

// Property: where Reach has no proof, a route is found or its absence is proven, and brute force agrees: for
// cones of nearly half a turn between blocked cells, for a narrow arc on each side of the fall line, and for
// both directions of a contour.
TEST(CellRoute, RoutesInNarrowConesMatchBruteForce) {
  Answers descents, arcs, contours;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    ask(testing::randomDescent(seed), seed, kSide * (kSide - 3) + kSide / 2, descents);
    ask(testing::randomBand(seed, -0.20, -0.19), seed, kSide * (kSide / 2) + kSide / 2, arcs);
  }
  for (unsigned seed = 1; seed <= 10; ++seed)
    ask(testing::randomBand(seed, -0.31, 1.0 / 256.0), seed, kSide * (kSide / 2) + kSide / 2, contours);
  for (const Answers& answers : {descents, arcs, contours}) {
    EXPECT_EQ(answers.wrong, 0);
    EXPECT_GT(answers.found, 100);
  }
  EXPECT_EQ(descents.neither, 0);
  EXPECT_LE(arcs.neither, 1);  // a goal at the edge of a narrow cone
  EXPECT_EQ(contours.neither, 0);
  EXPECT_GT(descents.out_of_reach, 5);
}

// Property: the work limit is enforced, and a limit one above the work of the search changes nothing.
TEST(CellRoute, WorkLimitIsEnforced) {
  const auto map = testing::contourPlane(0.4);
  const Segment places{{18.3, 18.2}, {20.4, 22.9}};
  const MotionCost cost(map);
  HeadingSets headings(map->cost());
  const CellRoute whole = cellRoute(cost, headings, places, 0.0);
  ASSERT_FALSE(whole.points.empty());
  ASSERT_GT(whole.ways, 10U);
  const CellRoute cut = cellRoute(cost, headings, places, 0.0, {.ways = whole.ways - 1});
  EXPECT_TRUE(cut.points.empty());
  EXPECT_FALSE(cut.all_ways);
  EXPECT_EQ(cut.ways, whole.ways - 1);
  EXPECT_EQ(cellRoute(cost, headings, places, 0.0, {.ways = whole.ways}).points, whole.points);
}

// Property: excluding the cells from which the goal is unreachable changes no result and never increases the
// work.
TEST(CellRoute, PruningUnreachableCellsKeepsTheResult) {
  std::size_t all = 0, some = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const auto map =
        testing::randomMap({.width = 12, .height = 12, .seed = seed, .blocked = 0.3, .roughness = 0.38});
    const Segment places{{1.3, 1.4}, {10.6, 10.8}};
    const MotionCost cost(map);
    if (!cost.allowed(places.from) || !cost.allowed(places.to)) continue;
    HeadingSets headings(map->cost());
    const Reach to(*map, headings, Reach::Sense::To, places.to);
    const CellRoute whole = cellRoute(cost, headings, places, 0.0);
    const CellRoute part = cellRoute(cost, headings, places, 0.0,
                                     {.may_enter = [&](maps::Cell cell) { return to.holds(cell); }});
    EXPECT_EQ(whole.points, part.points) << seed;
    EXPECT_LE(part.ways, whole.ways) << seed;
    all += whole.ways;
    some += part.ways;
  }
  EXPECT_LT(some, all);
}

TEST(CellRoute, RouteEndsWithinTheTolerance) {
  const auto map = testing::drawn({".....", "...##", "...##"});
  const Polyline way = routed(map, {{0.5, 0.5}, {4.5, 0.5}}, 2.1);
  ASSERT_FALSE(way.empty());
  EXPECT_LE(std::hypot(way.back().x_m - 4.5, way.back().y_m - 0.5), 2.1);
  EXPECT_TRUE(violations(*map, way).empty());
}

}  // namespace cell_chain_test

}  // namespace talus::planner
