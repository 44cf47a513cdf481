#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <talus/common/input_error.hpp>
#include <talus/planner/bench/moving_ai.hpp>
#include <talus/planner/grid/field_planner.hpp>

namespace talus::planner {
namespace moving_ai_test {

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

}  // namespace moving_ai_test
}  // namespace talus::planner
