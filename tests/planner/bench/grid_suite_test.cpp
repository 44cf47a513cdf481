#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <queue>
#include <vector>

#include <refused.hpp>

#include <talus/common/common.hpp>
#include <talus/planner/bench/grid_suite.hpp>
#include <talus/planner/grid/field_planner.hpp>

#include "drawn_map.hpp"

namespace talus::planner {

namespace grid_suite_test {

using testing::drawn;

// Optimum of MovingAI's scenario files: eight neighbours, corners are not cut.
double octile(const costmap::CostGrid& map, maps::Cell from, maps::Cell to) {
  const maps::Grid& grid = map.grid();
  const auto open = [&](maps::Cell c) { return grid.contains(c) && map.at(c).curve() == 0; };
  std::vector<double> best(grid.size(), INFINITY);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  best[grid.index(from)] = 0.0;
  queue.emplace(0.0, grid.index(from));
  while (!queue.empty()) {
    const auto [cost, index] = queue.top();
    queue.pop();
    if (cost > best[index]) continue;
    const maps::Cell at{static_cast<int>(index) % grid.width, static_cast<int>(index) / grid.width};
    for (int dr = -1; dr <= 1; ++dr)
      for (int dc = -1; dc <= 1; ++dc) {
        const maps::Cell next{at.column + dc, at.row + dr};
        if (!open(next) || !open({at.column + dc, at.row}) || !open({at.column, at.row + dr})) continue;
        const double through = cost + std::hypot(dc, dr);
        if (through >= best[grid.index(next)]) continue;
        best[grid.index(next)] = through;
        queue.emplace(through, grid.index(next));
      }
  }
  return best[grid.index(to)];
}

TEST(GridSuite, ShortestPathAroundWallsMatchesClosedForm) {
  const auto map = drawn({".....", ".###.", ".###.", "....."});
  // Closed form: from 0.5,0.5 past the corner 4,1 to 4.5,3.5: hypot(3.5, 0.5) + hypot(0.5, 2.5).
  EXPECT_NEAR(shortestAroundWalls_m(*map, {0, 0}, {4, 3}), std::hypot(3.5, 0.5) + std::hypot(0.5, 2.5),
              1e-12);
  EXPECT_NEAR(shortestAroundWalls_m(*map, {0, 0}, {4, 0}), 4.0, 1e-12);
  EXPECT_NEAR(shortestAroundWalls_m(*map, {4, 0}, {4, 3}), 3.0, 1e-12);
  EXPECT_TRUE(std::isinf(shortestAroundWalls_m(*drawn({"..#..", "..#.."}), {0, 0}, {4, 1})));
}

// Property: the any-angle optimum is no longer than the eight-neighbour optimum, and the field's route with a proof is
// between the any-angle optimum and 0.2 % above it.
TEST(GridSuite, FieldIsNearTheOptimum) {
  double worst = 0.0;
  std::size_t cases = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (const BenchmarkCase& asked : gridCases(64, 4, seed)) {
      ++cases;
      const maps::Grid& grid = asked.map->grid();
      const double grid_m = octile(*asked.map, *grid.cellAt(asked.start), *grid.cellAt(asked.goal));
      EXPECT_LE(asked.optimum_J, grid_m + 1e-9) << asked.name;
      Problem problem;
      problem.map = asked.map;
      problem.start = asked.start;
      problem.goal = asked.goal;
      problem.prove = true;
      const Plan plan = FieldPlanner().plan(problem);
      ASSERT_EQ(plan.status, RouteStatus::Found) << asked.name;
      EXPECT_GE(plan.cost_J, asked.optimum_J * (1.0 - 1e-6)) << asked.name;  // costs are floats
      worst = std::max(worst, plan.cost_J / asked.optimum_J - 1.0);
    }
  EXPECT_EQ(cases, 24u);
  EXPECT_LT(worst, 0.002);
}

TEST(GridSuite, OptionsOutOfRangeAreRejected) {
  EXPECT_REFUSED(gridCases(8, 1, 1), std::invalid_argument, "side = 8, must be >= 16");
  EXPECT_REFUSED(gridCases(32, 0, 1), std::invalid_argument, "pairs = 0, must be > 0");
}

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class MovingAi : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() /
        ("talus_moving_ai_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
    write("room.map", "type octile\nheight 4\nwidth 5\nmap\n.....\n.@@@.\n.@@@.\n.....\n");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::filesystem::path folder_;
};

TEST_F(MovingAi, ReadsCasesNorthUp) {
  // Closed form: from the south-west to the north-east corner around the block, without cutting corners, 7 m.
  write("room.scen", "version 1\n0\troom.map\t5\t4\t0\t3\t4\t0\t7\n");
  const auto cases = readMovingAi(path("room.scen"), 10);
  ASSERT_EQ(cases.size(), 1u);
  EXPECT_EQ(cases[0].start, (maps::Point{0.5, 0.5}));
  EXPECT_EQ(cases[0].goal, (maps::Point{4.5, 3.5}));
  Problem problem;
  problem.map = cases[0].map;
  problem.start = cases[0].start;
  problem.goal = cases[0].goal;
  const Plan plan = FieldPlanner().plan(problem);
  ASSERT_EQ(plan.status, RouteStatus::Found);
  // Property: the any-angle route is no longer than the grid's optimum and no shorter than the straight
  // line.
  EXPECT_LE(plan.cost_J, cases[0].optimum_J + 1e-9);
  EXPECT_GE(plan.cost_J, std::hypot(4.0, 3.0));
}

TEST_F(MovingAi, InvalidFilesAreRejected) {
  EXPECT_THAT([&] { readMovingAi(path("none.scen"), 1); },
              ThrowsMessage<InputError>(HasSubstr("cannot be read")));
  write("bad.scen", "version 1\n0 room.map 5 4 0\n");
  EXPECT_THAT([&] { readMovingAi(path("bad.scen"), 1); },
              ThrowsMessage<InputError>(HasSubstr("bad.scen:2: ")));
  write("far.scen", "version 1\n0\troom.map\t5\t4\t0\t3\t9\t0\t7\n");
  EXPECT_THAT([&] { readMovingAi(path("far.scen"), 1); }, ThrowsMessage<InputError>(HasSubstr("outside")));
  write("short.map", "type octile\nheight 4\nwidth 5\nmap\n.....\n..\n");
  write("short.scen", "version 1\n0\tshort.map\t5\t4\t0\t3\t4\t0\t7\n");
  EXPECT_THAT([&] { readMovingAi(path("short.scen"), 1); }, ThrowsMessage<InputError>(HasSubstr("shorter")));
}

TEST_F(MovingAi, MapMustBeInTheScenarioFolder) {
  const auto scenario = [&](const std::string& map) {
    write("a.scen", "version 1\n0\t" + map + "\t5\t4\t0\t3\t4\t0\t7\n");
    return [this] { readMovingAi(path("a.scen"), 1); };
  };
  for (const char* map : {"../../../../../../../etc/passwd", "/etc/passwd"})
    EXPECT_THAT(scenario(map), ThrowsMessage<InputError>(HasSubstr("outside of its folder"))) << map;
  std::filesystem::create_symlink("/etc/passwd", folder_ / "link.map");
  EXPECT_THAT(scenario("link.map"), ThrowsMessage<InputError>(HasSubstr("outside of its folder")));
  EXPECT_THAT(scenario("none.map"), ThrowsMessage<InputError>(HasSubstr("cannot be read")));
  // The collection names maps by folders that a user may not have.
  EXPECT_NO_THROW(scenario("maps/dao/room.map")());
  std::filesystem::create_directory(folder_ / "below");
  std::filesystem::rename(folder_ / "room.map", folder_ / "below" / "room.map");
  EXPECT_NO_THROW(scenario("below/room.map")());
}

}  // namespace grid_suite_test

}  // namespace talus::planner
