#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <site_fixture.hpp>

#include <talus/common/common.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/terramech/mobility/turning.hpp>

#include "drawn_map.hpp"

namespace talus::planner {

namespace polyline_test {

Polyline wandering(unsigned seed, int points) {
  std::mt19937 random(seed);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  Polyline line{{0.0, 0.0}};
  while (static_cast<int>(line.size()) < points)
    line.push_back({line.back().x_m + 5.0 * unit(), line.back().y_m + 8.0 * (unit() - 0.5)});
  return line;
}

// Property: the pieces join, keep the length, and end where the remaining length is a multiple of the piece.
TEST(Polyline, PiecesAreMeasuredFromTheEnd) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Polyline line = wandering(seed, 30);
    const auto pieces = cutFromEnd(line, 7.0, 3.0);
    double left_m = 0.0;
    for (std::size_t k = pieces.size(); k-- > 0; left_m += length_m(pieces[k])) {
      if (k + 1 < pieces.size()) {
        EXPECT_EQ(pieces[k].back(), pieces[k + 1].front());
        EXPECT_NEAR(std::remainder(left_m - 3.0, 7.0), 0.0, 1e-9);
      }
    }
    EXPECT_NEAR(left_m, length_m(line), 1e-9);
    EXPECT_EQ(pieces.front().front(), line.front());
    EXPECT_GT(length_m(pieces.front()), 3.5 - 1e-9);
    EXPECT_LE(length_m(pieces.front()), 10.5 + 1e-9);
  }
}

TEST(Polyline, SplitLeavesTheGivenLength) {
  const Polyline line{{0.0, 0.0}, {10.0, 0.0}, {10.0, 5.0}};
  for (const double left_m : {0.5, 5.0, 7.0, 14.5}) {
    const auto [before, behind] = splitAt(line, left_m);
    EXPECT_NEAR(length_m(behind), left_m, 1e-12);
    EXPECT_NEAR(length_m(before) + length_m(behind), 15.0, 1e-12);
    EXPECT_EQ(before.back(), behind.front());
    EXPECT_EQ(before.front(), line.front());
    EXPECT_EQ(behind.back(), line.back());
  }
}

TEST(Polyline, LineIsCutWhereItEntersACircle) {
  const Polyline line{{0, 0}, {10, 0}, {10, 10}};
  const auto near = [](const Polyline& got, const Polyline& want) {
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t i = 0; i < got.size(); ++i)
      EXPECT_NEAR(std::hypot(got[i].x_m - want[i].x_m, got[i].y_m - want[i].y_m), 0.0, 1e-7);
  };
  near(cutWithin(line, {10, 10}, 4.0), {{0, 0}, {10, 0}, {10, 6}});
  near(cutWithin(line, {5, 3}, 5.0), {{0, 0}, {1, 0}});  // 3-4-5, between two places outside
  near(cutWithin(line, {5, 3}, 2.9), line);              // outside the circle
  near(cutWithin(line, {-1, 0}, 1.5), {{0, 0}});         // begins inside
  near(cutWithin(line, {10, 10}, 0.0), line);
}

// Property: the pieces together are the line and long enough, and a line with one changed point is cut at
// the same points elsewhere.
TEST(Polyline, CutPointsDependOnTheNeighbourhoodOnly) {
  constexpr double kApart = 40.0;
  std::size_t common = 0, all = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Polyline line = wandering(seed, 400);
    Polyline other = line;
    other.insert(other.begin() + 200, {line[200].x_m + 0.5, line[200].y_m + 9.0});
    const auto pieces = cutAtMarks(line, kApart), others = cutAtMarks(other, kApart);
    Polyline joined;
    for (const Polyline& piece : pieces) {
      append(joined, piece);
      if (&piece != &pieces.front() && &piece != &pieces.back()) {
        EXPECT_GT(length_m(piece), kApart);
      }
    }
    EXPECT_EQ(joined, line);
    EXPECT_GT(pieces.size(), 5U);
    for (const Polyline& piece : pieces)
      common += static_cast<std::size_t>(std::count(others.begin(), others.end(), piece));
    all += pieces.size();
  }
  EXPECT_GE(common, all - 20 * 4);
}

using costmap::testRover;
using testing::drawn;
using testing::randomMap;

TEST(MotionCost, CostIsTheSumOverCells) {
  const MotionCost cost(drawn({".12"}));
  // Closed form: 0.5 m at 10 J/m, 1 m at 20, 0.25 m at 30.
  EXPECT_NEAR(cost({{0.5, 0.5}, {2.25, 0.5}}), 5.0 + 20.0 + 7.5, 1e-6);
}

TEST(MotionCost, ClimbingDescendingAndCrossingCostsDiffer) {
  const MotionCost cost(drawn({">>>", ">>>", ">>>"}));
  const double up = cost({{0.5, 1.5}, {2.5, 1.5}}), down = cost({{2.5, 1.5}, {0.5, 1.5}});
  // Closed form: the gradient 0.2 is 205/1024; between nodes of the curve a parabola of 400 is off by 400 / 4 / 256^2.
  const double g = 205.0 / 1024.0;
  EXPECT_NEAR(up, 2 * (10 + 100 * g + 400 * g * g), 0.0032);
  EXPECT_NEAR(down, 2 * (10 + 400 * g * g), 0.0032);
  EXPECT_NEAR(cost({{1.5, 0.5}, {1.5, 2.5}}), 20.0, 1e-4);
}

TEST(MotionCost, MotionBetweenDiagonalBlocksIsInfeasible) {
  const MotionCost cost(drawn({"#.", ".#"}));
  EXPECT_TRUE(std::isinf(cost({{0.5, 0.5}, {1.5, 1.5}})));
  EXPECT_TRUE(std::isinf(cost({{1.25, 1.25}, {0.75, 0.75}})));
}

TEST(MotionCost, MotionThroughACornerRequiresBothNeighbours) {
  const MotionCost cost(drawn({"..", ".#"}));
  EXPECT_TRUE(std::isinf(cost({{0.5, 0.5}, {1.5, 1.5}})));
  EXPECT_TRUE(std::isfinite(cost({{0.5, 0.6}, {1.4, 1.5}})));
}

TEST(MotionCost, TurnOnACornerRequiresAllTouchedCells) {
  const MotionCost cost(drawn({"#.", ".#"}));
  EXPECT_TRUE(std::isinf(cost.along({{0.5, 0.5}, {1.0, 1.0}, {1.5, 1.5}})));
  EXPECT_TRUE(std::isinf(cost.along({{0.5, 0.5}, {1.0, 1.0}, {1.5, 1.2}})));
}

TEST(MotionCost, MotionAlongAnEdgeUsesTheCostlierSide) {
  const MotionCost cost(drawn({"222", "...", "###"}));
  EXPECT_NEAR(cost({{0.5, 2.0}, {2.5, 2.0}}), 60.0, 1e-6);
  EXPECT_TRUE(std::isinf(cost({{0.5, 1.0}, {2.5, 1.0}})));
  EXPECT_NEAR(cost({{0.5, 3.0}, {2.5, 3.0}}), 60.0, 1e-6);
}

TEST(MotionCost, TurnCostIsProportionalToAngle) {
  const MotionCost cost(testing::plane(8, {0.0, 0.0}, 7.0));
  const std::vector<maps::Point> bent{{1.5, 1.5}, {4.5, 1.5}, {4.5, 5.5}, {2.5, 5.5}};
  // Closed form: nine metres at 10 J and two quarter turns at 7 J a radian.
  EXPECT_NEAR(cost.along(bent), 90.0 + 7.0 * std::numbers::pi, 1e-4);
  EXPECT_NEAR(cost.ofLegs(bent), 90.0, 1e-4);
  EXPECT_NEAR(cost.along({{1.5, 1.5}, {4.5, 1.5}, {4.5, 1.5}, {6.5, 1.5}}), 50.0, 1e-4)
      << "a point given twice";
}

// A square rover that is stable on a plane of 0.6 in diagonal headings tips in the headings between; the
// limit along an axis is half / height = 0.5.
TEST(MotionCost, TurnThroughTippingHeadingsIsInfeasible) {
  terramech::Rover rover = testRover();
  rover.wheelbase_m = rover.track_m = 1.0;
  rover.centre_of_mass_height_m = 1.0;
  const MotionCost cost(
      testing::plane(20, {0.0, 0.6}, 0.0, std::make_shared<const terramech::RoverStance>(rover)));
  EXPECT_NEAR(cost.along({{2.5, 2.5}, {6.5, 6.5}, {10.5, 10.5}}), 80.0 * std::numbers::sqrt2, 1e-3)
      << "straight on";
  EXPECT_NEAR(cost.along({{2.5, 2.5}, {6.5, 6.5}, {10.5, 9.5}}), 10.0 * (std::hypot(4, 4) + std::hypot(4, 3)),
              1e-3);
  EXPECT_EQ(cost.along({{2.5, 2.5}, {6.5, 6.5}, {2.5, 10.5}}), kInfinity) << "past straight up";
  EXPECT_EQ(cost.along({{2.5, 2.5}, {6.5, 6.5}, {10.5, 2.5}}), kInfinity) << "past across";
}

TEST(MotionCost, MotionsMustStayWithinTheMap) {
  const MotionCost cost(drawn({"...", "..."}));
  EXPECT_NEAR(cost({{0.0, 0.5}, {3.0, 0.5}}), 30.0, 1e-6);
  EXPECT_TRUE(std::isinf(cost({{0.5, 0.5}, {3.5, 0.5}})));
  EXPECT_TRUE(std::isinf(cost({{0.5, 0.5}, {0.5, -0.1}})));
  EXPECT_TRUE(std::isinf(cost({{0.5, 0.5}, {std::nan(""), 0.5}})));
  EXPECT_EQ(cost({{1.5, 0.5}, {1.5, 0.5}}), 0.0);
}

TEST(MotionCost, UnknownCellsAreInfeasible) {
  const MotionCost cost(drawn({".?."}));
  EXPECT_TRUE(std::isinf(cost({{0.5, 0.5}, {2.5, 0.5}})));
  EXPECT_FALSE(cost.allowed({1.5, 0.5}));
  EXPECT_TRUE(cost.allowed({0.5, 0.5}));
}

// Property: the integral is the limit of fine sampling; with 1e5 samples over at most 30 m and cells of at
// least 1e-2 m on the segment, the sum is off by less than 40 crossings of 3e-4 m at 300 J/m.
TEST(MotionCost, MatchesFineSampling) {
  const auto map = randomMap({.blocked = 0.0, .roughness = 0.13});
  const MotionCost cost(map);
  std::mt19937 random(7);
  const auto coordinate = [&random] { return 20.0 * static_cast<double>(random()) / 4294967296.0; };
  int allowed = 0;
  for (int k = 0; k < 50; ++k) {
    const maps::Point a{coordinate(), coordinate()}, b{coordinate(), coordinate()};
    const double length = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    const costmap::Direction heading{(b.x_m - a.x_m) / length, (b.y_m - a.y_m) / length};
    const int samples = 100'000;
    double sum = 0.0;
    for (int i = 0; i < samples; ++i) {
      const double t = (i + 0.5) / samples;
      const auto cell = map->grid().cellAt({a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m)});
      sum += static_cast<double>(map->cost().costPerMetre(map->at(*cell), heading));
    }
    ASSERT_EQ(std::isfinite(cost({a, b})), std::isfinite(sum)) << k;
    if (std::isinf(sum)) continue;
    ++allowed;
    EXPECT_NEAR(cost({a, b}), sum * length / samples, 4.0);
  }
  EXPECT_GT(allowed, 20);
}

constexpr maps::Grid kGrid{.width = 7, .height = 5, .resolution_m = 0.5, .south_west = {10.0, 20.0}};

// Closed form, by brute force: a cell counts if its nearest point is within the radius.
TEST(CellsWithin, MatchesBruteForceOverCells) {
  for (double x = 9.113; x < 14.5; x += 0.37)
    for (double y = 19.2; y < 23.4; y += 0.41)
      for (const double radius_m : {0.1, 0.7, 1.9}) {
        std::vector<maps::Cell> expected;
        for (int row = 0; row < kGrid.height; ++row)
          for (int column = 0; column < kGrid.width; ++column) {
            const double west = 10.0 + 0.5 * column, south = 20.0 + 0.5 * row;
            const double dx = x - std::clamp(x, west, west + 0.5), dy = y - std::clamp(y, south, south + 0.5);
            if (std::hypot(dx, dy) <= radius_m) expected.push_back({column, row});
          }
        EXPECT_EQ(cellsWithin(kGrid, {x, y}, radius_m), expected) << x << ' ' << y << ' ' << radius_m;
      }
}

TEST(CellsWithin, NonFiniteAndDistantPlacesHaveNoCells) {
  for (const double far : {1e12, 1e300, static_cast<double>(INFINITY), static_cast<double>(NAN)})
    for (const double radius_m : {0.0, 0.5, 1e3}) {
      EXPECT_TRUE(cellsWithin(kGrid, {far, 21.0}, radius_m).empty()) << far;
      EXPECT_TRUE(cellsWithin(kGrid, {11.0, -far}, radius_m).empty()) << far;
    }
  EXPECT_EQ(cellsWithin(kGrid, {11.0, 21.0}, 1e300).size(), kGrid.size());
}

}  // namespace polyline_test

}  // namespace talus::planner
