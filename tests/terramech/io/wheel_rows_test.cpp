#include <cmath>
#include <numbers>
#include <string>

#include <talus/common/common.hpp>
#include <talus/terramech/io/wheel_rows.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "temporary_file.hpp"

namespace talus::terramech {
namespace wheel_rows_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::string kHead = "load_N,torque_Nm,sinkage_m,slip,wheel_radius_m,wheel_width_m,run\n";

WheelRows rowsOf(const std::string& content, const WheelRowOptions& options = {}) {
  const test::TemporaryFile file{content};
  return readWheelRows(file.path(), options, {});
}

TEST(WheelRows, ReadsSamplesWithWheelLineAndText) {
  const WheelRows rows =
      rowsOf(kHead + "80,2,0.01,0.3,0.1,0.2,a\n81,2,0,0.3,0.1,0.2,b\n82,3,0.02,0.4,0.15,0.2,c\n");
  ASSERT_EQ(rows.samples.size(), 2U);
  EXPECT_EQ(rows.samples[1].load_N, 82.0);
  EXPECT_EQ(rows.samples[1].slip, 0.4);
  EXPECT_THAT(rows.lines, ElementsAre(2, 4));
  EXPECT_FALSE(rows.one_wheel);
  EXPECT_EQ(rows.wheel.radius_m, 0.1);
  EXPECT_EQ(rows.wheels[1].radius_m, 0.15);
  ASSERT_FALSE(rows.rejected.empty());
  EXPECT_EQ(rows.rejected.front().line, 3U);
  EXPECT_THAT(rows.rejected.front().reason, HasSubstr("sinkage_m = 0"));
}

TEST(WheelRows, BrakedWheelIsUsedOnlyIfSlipIsNotRequired) {
  const std::string content = kHead + "80,2,0.01,-0.3,0.1,0.2,a\n80,2,0.01,0.3,0.1,0.2,a\n";
  EXPECT_EQ(rowsOf(content).samples.size(), 1U);
  EXPECT_EQ(rowsOf(content, {.needs_slip = false}).samples.size(), 2U);
  EXPECT_EQ(rowsOf("load_N,torque_Nm,sinkage_m,wheel_radius_m,wheel_width_m\n80,2,0.01,0.1,0.2\n",
                   {.needs_slip = false})
                .samples[0]
                .slip,
            0.0);
}

TEST(WheelRows, SinkageAtOrAboveTheLimitIsRejectedWithItsLine) {
  const std::string content =
      kHead + "80,2,0.01,0.3,0.1,0.2,a\n80,2,0.13,0.3,0.1,0.2,a\n80,2,0.1,0.3,0.1,0.2,a\n";
  EXPECT_EQ(rowsOf(content).samples.size(), 3U);
  const WheelRows rows = rowsOf(content, {.deepest = 1.0});
  EXPECT_EQ(rows.samples.size(), 1U);
  ASSERT_EQ(rows.rejected.size(), 2U);
  EXPECT_EQ(rows.rejected[0].line, 3U);
  EXPECT_EQ(rows.rejected[0].reason, "sinkage_m = 0.13, must be < 0.1: the wheel model ends at the axle");
  EXPECT_EQ(rows.rejected[1].line, 4U);
}

TEST(WheelRows, WheelAtASlipAngleIsRejected) {
  const WheelRows rows =
      rowsOf("slip_angle_rad," + kHead +
             "0.09,80,2,0.01,0.3,0.1,0.2,a\n-0.11,80,2,0.01,0.3,0.1,0.2,a\n,80,2,0.01,0.3,0.1,0.2,a\n");
  EXPECT_THAT(rows.lines, ElementsAre(2, 4));
  ASSERT_FALSE(rows.rejected.empty());
  EXPECT_THAT(rows.rejected.front().reason, HasSubstr("slip_angle_rad = -0.11: only straight wheels"));
}

TEST(WheelRows, SideForceWithoutSlipAngleIsRejected) {
  const std::string row = "80,2,0.01,0.3,0.1,0.2,a\n";
  const WheelRows rows = rowsOf("side_force_N,slip_angle_rad," + kHead + "12,," + row + "0,," + row + ",," +
                                row + "12,0," + row);
  EXPECT_THAT(rows.lines, ElementsAre(3, 4, 5));
  ASSERT_FALSE(rows.rejected.empty());
  EXPECT_EQ(rows.rejected.front().line, 2U);
  EXPECT_THAT(rows.rejected.front().reason, HasSubstr("side_force_N = 12 without slip_angle_rad"));
  EXPECT_THAT([&] { rowsOf("side_force_N," + kHead + "12," + row); },
              ThrowsMessage<InputError>(HasSubstr(":2: no usable row: side_force_N = 12 without")));
}

TEST(WheelRows, RoverWheelOverridesTheFile) {
  const std::string rover = libraryRovers().front();
  const WheelRows rows = rowsOf(kHead + "80,2,0.01,0.3,0.9,0.9,a\n", {.rover = rover});
  EXPECT_EQ(rows.wheel.radius_m, loadRover(rover).wheel.radius_m);
  EXPECT_EQ(rows.wheels[0].width_m, loadRover(rover).wheel.width_m);
}

TEST(WheelRows, MissingColumnsAreNamed) {
  EXPECT_THAT([] { rowsOf("load_N,torque_Nm,sinkage_m,slip\n80,2,0.01,0.3\n"); },
              ThrowsMessage<InputError>(HasSubstr("lacks column wheel_radius_m; add it, or pass --rover")));
  EXPECT_THAT([] { rowsOf("load_N,torque_Nm,slip,wheel_radius_m,wheel_width_m\n80,2,0.3,0.1,0.1\n"); },
              ThrowsMessage<InputError>(HasSubstr("sinkage_m")));
  EXPECT_THAT([] { rowsOf(kHead + "80,2,0.01,0.3,,,a\n"); },
              ThrowsMessage<InputError>(HasSubstr("has no wheel_radius_m or wheel_width_m")));
  EXPECT_THAT([] { rowsOf(kHead + "80,2,0,0.3,0.1,0.2,a\n"); },
              ThrowsMessage<InputError>(HasSubstr("no usable row: sinkage_m = 0")));
  EXPECT_THROW(rowsOf(kHead + "-80,2,0.01,0.3,0.1,0.2,a\n"), InputError);
  EXPECT_THROW(rowsOf(kHead), InputError);
}

BevameterTable tableOf(const std::string& content, double plate_width_m = 0.0) {
  const test::TemporaryFile file{content};
  return readBevameterTable(file.path(), plate_width_m, {});
}

TEST(BevameterTable, ReadsShearAndPlateRowsFromOneFile) {
  const BevameterTable table = tableOf(
      "normal_stress_Pa,shear_stress_Pa,shear_displacement_m,plate_d_m,p_Pa,z_m\n"
      "1000,600,0.01,,,\n,,,0.1,5000,0.02\n2000,900,0.02,0.05,7000,0.01\n");
  ASSERT_EQ(table.shear.size(), 2U);
  EXPECT_EQ(table.shear[0].normal_Pa, 1000.0);
  EXPECT_EQ(table.shear[1].displacement_m, 0.02);
  ASSERT_EQ(table.plates.size(), 1U);
  ASSERT_EQ(table.plates[0].readings.size(), 2U);
  EXPECT_EQ(table.plates[0].readings[0].plate_width_m, 0.1);
  EXPECT_EQ(table.plates[0].readings[1].pressure_Pa, 7000.0);
  EXPECT_FALSE(table.width_from_force);
  EXPECT_TRUE(table.rejected.empty());
}

TEST(BevameterTable, StatedPlateWidthOverridesTheColumn) {
  const BevameterTable table =
      tableOf("plate_width_m,pressure_Pa,sinkage_m\n0.1,5000,0.02\n0.2,6000,0.02\n", 0.07);
  for (const PlateReading& r : table.plates.at(0).readings) EXPECT_EQ(r.plate_width_m, 0.07);
}

// Closed form: F / p is the area of the plate, pi d^2 / 4; test by test.
TEST(BevameterTable, RoundPlateSizeFollowsFromForceOverPressure) {
  std::string content = "test,F_N,p_Pa,z_m\n";
  for (int k = 1; k < 6; ++k)
    for (const double d : {0.05, 0.1})
      content += (d < 0.07 ? "small," : "large,") +
                 std::to_string(1000.0 * k * std::numbers::pi * d * d / 4) + "," + std::to_string(1000 * k) +
                 "," + std::to_string(0.001 * k) + "\n";
  const BevameterTable table = tableOf(content);
  EXPECT_TRUE(table.width_from_force);
  ASSERT_EQ(table.plates.size(), 2U);
  ASSERT_EQ(table.plates[0].readings.size(), 5U);
  EXPECT_NEAR(table.plates[0].readings[0].plate_width_m, 0.05, 1e-12);
  EXPECT_NEAR(table.plates[1].readings[0].plate_width_m, 0.1, 1e-12);
}

TEST(BevameterTable, TrialsAndSoilsFormSeparateTests) {
  const BevameterTable table = tableOf(
      "soil,trial,note,plate_width_m,pressure_Pa,sinkage_m\n"
      "sand,1,a,0.1,5000,0.01\nsand,1,b,0.1,7000,0.02\nsand,2,c,0.1,5000,0.01\nclay,1,d,0.1,9000,0.02\n");
  ASSERT_EQ(table.plates.size(), 3U);
  EXPECT_EQ(table.plates[0].readings.size(), 2U);  // a different note in each row does not separate trials
  EXPECT_EQ(table.plates[1].soil, "sand");
  EXPECT_EQ(table.plates[2].soil, "clay");
}

TEST(BevameterTable, VaryingForceOverPressureIsRejected) {
  EXPECT_THAT([] { tableOf("F_N,p_Pa,z_m\n1,1000,0.01\n2,1500,0.02\n3,1700,0.03\n"); },
              ThrowsMessage<InputError>(HasSubstr("no usable row")));
}

TEST(BevameterTable, UnloadedRowsAreRejectedWithTheirLine) {
  const BevameterTable table =
      tableOf("plate_width_m,pressure_Pa,sinkage_m\n0.1,0,0.02\n0.1,5000,0.02\n0.1,5000,0\n");
  ASSERT_EQ(table.plates.size(), 1U);
  EXPECT_EQ(table.plates[0].readings.size(), 1U);
  ASSERT_EQ(table.rejected.size(), 2U);
  EXPECT_EQ(table.rejected[0].line, 2U);
  EXPECT_EQ(table.rejected[1].line, 4U);
}

TEST(BevameterTable, TableWithoutTestColumnsIsRejected) {
  EXPECT_THAT([] { tableOf("load_N,slip\n80,0.3\n"); },
              ThrowsMessage<InputError>(HasSubstr("lacks the columns of a plate test or a shear test")));
}

}  // namespace wheel_rows_test
}  // namespace talus::terramech
