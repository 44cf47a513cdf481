#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <site_fixture.hpp>

#include <talus/costmap/ground/wheel_swath.hpp>

namespace talus::costmap {

namespace wheel_swath_test {

// Closed form, by brute force: each cell is compared with every cell around it.
TEST(ClassBorders, BordersAreCellsWithAnotherClassWithinReach) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 60; ++trial) {
    const maps::Grid grid{.width = 1 + static_cast<int>(random() % 15),
                          .height = 1 + static_cast<int>(random() % 15),
                          .resolution_m = 1.0,
                          .south_west = {}};
    maps::Raster<std::uint8_t> classes(grid, 1);
    for (std::uint8_t& c : classes.values())
      if (random() % 20 == 0) c = 2;
    const int reach = 1 + trial % 4;
    const auto border = classBorders(classes, reach);
    for (int row = 0; row < grid.height; ++row)
      for (int column = 0; column < grid.width; ++column) {
        bool other = false;
        for (int dy = -reach; dy <= reach; ++dy)
          for (int dx = -reach; dx <= reach; ++dx) {
            const maps::Cell near{column + dx, row + dy};
            other = other || (grid.contains(near) && classes[near] != classes[{column, row}]);
          }
        ASSERT_EQ(border[grid.index({column, row})], other) << trial << ' ' << column << ' ' << row;
      }
  }
  EXPECT_TRUE(classBorders({}, 2).empty());
}

using Around = std::vector<WheelSwath::Ground>;

WheelSwath::Ground strong() {
  return {0, {.pull = {0.3, 0.05}, .sinkage = {0.1, 0.1}}};
}

WheelSwath::Ground trap() {
  return {1, {.pull = {-0.25, 0.02}, .sinkage = {0.8, 0.1}}};
}

Around all(const WheelSwath& swath, const WheelSwath::Ground& ground) {
  const auto side = static_cast<std::size_t>(2 * swath.reach() + 1);
  return Around(side * side, ground);
}

WheelSwath::Ground& at(Around& around, const WheelSwath& swath, maps::Cell offset) {
  const int side = 2 * swath.reach() + 1;
  return around[static_cast<std::size_t>((offset.row + swath.reach()) * side + offset.column +
                                         swath.reach())];
}

TEST(WheelSwath, PoseErrorExtendsTheReach) {
  const WheelSwath exact(testRover(), 0.25, 0.0), unsure(testRover(), 0.25, 0.6);
  EXPECT_GE(unsure.reach(), exact.reach() + 2);
  Around around = all(unsure, strong());
  for (int row = -unsure.reach(); row <= unsure.reach(); ++row) at(around, unsure, {4, row}) = trap();
  EXPECT_LT(unsure.judged(around).belief.pull.value, 0.3);
}

// Property: for any position of the centre in the cell and any heading, the mean pull of the wheels is at
// least the stated value, up to the step of positions and headings. The stated value is never better than
// the cell's own ground.
TEST(WheelSwath, PullIsTheMinimumOverPositionsAndHeadings) {
  std::mt19937_64 random(5);
  const auto drawn = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const terramech::Rover rover = testRover();
  const double cell_m = 0.5;
  const WheelSwath swath(rover, cell_m, 0.0);
  double missed = 0.0;
  int standings = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Around around = all(swath, strong());
    for (auto& ground : around)
      if (drawn(0.0, 1.0) < 0.3) ground = trap();
    const double said = swath.judged(around).belief.pull.value;
    EXPECT_LE(said, around[around.size() / 2].belief.pull.value);
    for (int k = 0; k < 500; ++k, ++standings) {
      const double x = drawn(-0.5, 0.5) * cell_m, y = drawn(-0.5, 0.5) * cell_m;
      const double heading = drawn(0.0, 2.0 * std::numbers::pi);
      double sum = 0.0;
      for (const double along : {-0.5, 0.5})
        for (const double side : {-0.5, 0.5}) {
          double least = INFINITY;
          for (double across = -0.5; across <= 0.5; across += 0.1) {
            const double a = along * rover.wheelbase_m,
                         b = side * rover.track_m + across * rover.wheel.width_m;
            const double wx = x + a * std::cos(heading) - b * std::sin(heading);
            const double wy = y + a * std::sin(heading) + b * std::cos(heading);
            const maps::Cell offset{static_cast<int>(std::floor(wx / cell_m + 0.5)),
                                    static_cast<int>(std::floor(wy / cell_m + 0.5))};
            ASSERT_LE(std::max(std::abs(offset.column), std::abs(offset.row)), swath.reach());
            least = std::min(least, at(around, swath, offset).belief.pull.value);
          }
          sum += 0.25 * least;
        }
      missed += sum < said - 1e-9;
    }
  }
  // A wheel may touch a corner of a cell between two of the sampled positions and headings.
  EXPECT_LT(missed / standings, 0.01);
}

}  // namespace wheel_swath_test

}  // namespace talus::costmap
