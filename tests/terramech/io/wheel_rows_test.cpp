#include <string>

#include <talus/common/common.hpp>
#include <talus/terramech/io/terramech_io.hpp>
#include <talus/terramech/io/wheel_rows.hpp>

#include "temporary_file.hpp"

namespace talus::terramech {
namespace wheel_rows_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::string kHead = "load_N,torque_Nm,sinkage_m,slip,wheel_radius_m,wheel_width_m,run\n";

WheelRows read(const std::string& content, const WheelRowOptions& options = {}) {
  const test::TemporaryFile file{content};
  return readWheelRows(file.path(), options, {});
}

TEST(WheelRows, ReadsSamplesWithWheelLineAndText) {
  const WheelRows rows =
      read(kHead + "80,2,0.01,0.3,0.1,0.2,a\n81,2,0,0.3,0.1,0.2,b\n82,3,0.02,0.4,0.15,0.2,c\n");
  ASSERT_EQ(rows.samples.size(), 2U);
  EXPECT_EQ(rows.samples[1].load_N, 82.0);
  EXPECT_EQ(rows.samples[1].slip, 0.4);
  EXPECT_THAT(rows.lines, ElementsAre(2, 4));
  EXPECT_THAT(rows.words.front().values, ElementsAre("a", "c"));
  EXPECT_FALSE(rows.one_wheel);
  EXPECT_EQ(rows.wheel.radius_m, 0.1);
  EXPECT_EQ(rows.readings()[1].wheel.radius_m, 0.15);
  ASSERT_FALSE(rows.rejected.empty());
  EXPECT_EQ(rows.rejected.front().line, 3U);
  EXPECT_THAT(rows.rejected.front().reason, HasSubstr("sinkage_m = 0"));
}

TEST(WheelRows, BrakedWheelIsUsedOnlyIfSlipIsNotRequired) {
  const std::string content = kHead + "80,2,0.01,-0.3,0.1,0.2,a\n80,2,0.01,0.3,0.1,0.2,a\n";
  EXPECT_EQ(read(content).samples.size(), 1U);
  EXPECT_EQ(read(content, {.needs_slip = false}).samples.size(), 2U);
  EXPECT_EQ(read("load_N,torque_Nm,sinkage_m,wheel_radius_m,wheel_width_m\n80,2,0.01,0.1,0.2\n",
                 {.needs_slip = false})
                .samples[0]
                .slip,
            0.0);
}

TEST(WheelRows, SinkageAtOrAboveTheLimitIsRejectedWithItsLine) {
  const std::string content =
      kHead + "80,2,0.01,0.3,0.1,0.2,a\n80,2,0.13,0.3,0.1,0.2,a\n80,2,0.1,0.3,0.1,0.2,a\n";
  EXPECT_EQ(read(content).samples.size(), 3U);
  const WheelRows rows = read(content, {.deepest = 1.0});
  EXPECT_EQ(rows.samples.size(), 1U);
  ASSERT_EQ(rows.rejected.size(), 2U);
  EXPECT_EQ(rows.rejected[0].line, 3U);
  EXPECT_EQ(rows.rejected[0].reason, "sinkage_m = 0.13, must be < 0.1: the wheel model ends at the axle");
  EXPECT_EQ(rows.rejected[1].line, 4U);
}

TEST(WheelRows, WheelAtASlipAngleIsRejected) {
  const WheelRows rows =
      read("slip_angle_rad," + kHead +
           "0.09,80,2,0.01,0.3,0.1,0.2,a\n-0.11,80,2,0.01,0.3,0.1,0.2,a\n,80,2,0.01,0.3,0.1,0.2,a\n");
  EXPECT_THAT(rows.lines, ElementsAre(2, 4));
  ASSERT_FALSE(rows.rejected.empty());
  EXPECT_THAT(rows.rejected.front().reason, HasSubstr("slip_angle_rad = -0.11: only straight wheels"));
}

TEST(WheelRows, SideForceWithoutSlipAngleIsRejected) {
  const std::string row = "80,2,0.01,0.3,0.1,0.2,a\n";
  const WheelRows rows =
      read("side_force_N,slip_angle_rad," + kHead + "12,," + row + "0,," + row + ",," + row + "12,0," + row);
  EXPECT_THAT(rows.lines, ElementsAre(3, 4, 5));
  ASSERT_FALSE(rows.rejected.empty());
  EXPECT_EQ(rows.rejected.front().line, 2U);
  EXPECT_THAT(rows.rejected.front().reason, HasSubstr("side_force_N = 12 without slip_angle_rad"));
  EXPECT_THAT(rows.words.front().values, ElementsAre("a", "a", "a"));
  EXPECT_THAT([&] { read("side_force_N," + kHead + "12," + row); },
              ThrowsMessage<InputError>(HasSubstr(":2: no usable row: side_force_N = 12 without")));
}

TEST(WheelRows, RoverWheelOverridesTheFile) {
  const std::string rover = libraryRovers().front();
  const WheelRows rows = read(kHead + "80,2,0.01,0.3,0.9,0.9,a\n", {.rover = rover});
  EXPECT_EQ(rows.wheel.radius_m, loadRover(rover).wheel.radius_m);
  EXPECT_EQ(rows.wheels[0].width_m, loadRover(rover).wheel.width_m);
}

TEST(WheelRows, MissingColumnsAreNamed) {
  EXPECT_THAT([] { read("load_N,torque_Nm,sinkage_m,slip\n80,2,0.01,0.3\n"); },
              ThrowsMessage<InputError>(HasSubstr("lacks column wheel_radius_m; add it, or pass --rover")));
  EXPECT_THAT([] { read("load_N,torque_Nm,slip,wheel_radius_m,wheel_width_m\n80,2,0.3,0.1,0.1\n"); },
              ThrowsMessage<InputError>(HasSubstr("sinkage_m")));
  EXPECT_THAT([] { read(kHead + "80,2,0.01,0.3,,,a\n"); },
              ThrowsMessage<InputError>(HasSubstr("has no wheel_radius_m or wheel_width_m")));
  EXPECT_THAT([] { read(kHead + "80,2,0,0.3,0.1,0.2,a\n"); },
              ThrowsMessage<InputError>(HasSubstr("no usable row: sinkage_m = 0")));
  EXPECT_THROW(read(kHead + "-80,2,0.01,0.3,0.1,0.2,a\n"), InputError);
  EXPECT_THROW(read(kHead), InputError);
}

}  // namespace wheel_rows_test
}  // namespace talus::terramech
