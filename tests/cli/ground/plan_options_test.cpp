#include <numbers>

#include <CLI/CLI.hpp>
#include <site_map.hpp>

#include <talus/cli/ground/mission.hpp>

namespace talus::cli {

namespace plan_options_test {

MotionOptions parsed(const std::string& line) {
  CLI::App app;
  MotionOptions drive;
  addMotionOptions(app, drive);
  app.parse(line);
  return drive;
}

// Closed form: degrees are converted to radians.
TEST(MotionOptions, HeadingsAreAcceptedInRadiansOrDegrees) {
  EXPECT_EQ(*parsed("--start-heading 1.5").start_heading_rad, 1.5);
  EXPECT_NEAR(*parsed("--goal-heading-deg 90").goal_heading_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_FALSE(parsed("").any());
  EXPECT_THROW(parsed("--start-heading 1 --start-heading-deg 2"), CLI::ExcludesError);
  for (const char* angle : {"nan", "90"})
    EXPECT_THROW(parsed(std::string("--start-heading ") + angle), CLI::ValidationError) << angle;
  for (const char* radius : {"-1", "1e-9", "1e-15", "0.0009", "1001"})
    EXPECT_THROW(parsed("--turning-radius " + std::string(radius)), CLI::ValidationError) << radius;
  EXPECT_EQ(parsed("--turning-radius 0").turning_radius_m, 0.0);
  EXPECT_EQ(parsed("--turning-radius 0.001").turning_radius_m, 0.001);
  EXPECT_THROW(parsed("--chassis tank"), CLI::ValidationError);
}

TEST(MotionOptions, CommandLineOverridesTheRoverKinematics) {
  const auto map = costmap::mapOf({"111", "111"});
  const planner::Kinematics own = kinematicsOf(parsed(""), map);
  EXPECT_EQ(own.turning_radius_m, map.model().rover().turning_radius_m);
  EXPECT_TRUE(own.may_reverse);
  const planner::Kinematics said = kinematicsOf(parsed("--turning-radius 3.5 --no-reverse"), map);
  EXPECT_EQ(said.turning_radius_m, 3.5);
  EXPECT_FALSE(said.may_reverse);
}

TEST(MotionOptions, ChassisTypeFollowsTheOption) {
  const auto map = costmap::mapOf(std::vector<std::string>(8, "11111111"));
  EXPECT_FALSE(chassisOf("", map));
  const auto rigid = chassisOf(parsed("--chassis rigid").chassis, map);
  ASSERT_TRUE(rigid);
  EXPECT_EQ(rigid->refusal({{104.0, 204.0}, 0.0}), "");                 // Closed form: level ground
  EXPECT_THROW(chassisOf("rocker-bogie", map), std::invalid_argument);  // rover with four wheels
}

}  // namespace plan_options_test

}  // namespace talus::cli
