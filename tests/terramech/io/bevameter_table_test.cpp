#include <cmath>
#include <numbers>
#include <string>

#include <talus/common/common.hpp>
#include <talus/terramech/io/bevameter_table.hpp>

#include "temporary_file.hpp"

namespace talus::terramech {
namespace bevameter_table_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

BevameterTable read(const std::string& content, double plate_width_m = 0.0) {
  const test::TemporaryFile file{content};
  return readBevameterTable(file.path(), plate_width_m, {});
}

TEST(BevameterTable, ReadsShearAndPlateRowsFromOneFile) {
  const BevameterTable table = read(
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
      read("plate_width_m,pressure_Pa,sinkage_m\n0.1,5000,0.02\n0.2,6000,0.02\n", 0.07);
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
  const BevameterTable table = read(content);
  EXPECT_TRUE(table.width_from_force);
  ASSERT_EQ(table.plates.size(), 2U);
  ASSERT_EQ(table.plates[0].readings.size(), 5U);
  EXPECT_NEAR(table.plates[0].readings[0].plate_width_m, 0.05, 1e-12);
  EXPECT_NEAR(table.plates[1].readings[0].plate_width_m, 0.1, 1e-12);
}

TEST(BevameterTable, TrialsAndSoilsFormSeparateTests) {
  const BevameterTable table = read(
      "soil,trial,note,plate_width_m,pressure_Pa,sinkage_m\n"
      "sand,1,a,0.1,5000,0.01\nsand,1,b,0.1,7000,0.02\nsand,2,c,0.1,5000,0.01\nclay,1,d,0.1,9000,0.02\n");
  ASSERT_EQ(table.plates.size(), 3U);
  EXPECT_EQ(table.plates[0].readings.size(), 2U);  // a different note in each row does not separate trials
  EXPECT_EQ(table.plates[1].soil, "sand");
  EXPECT_EQ(table.plates[2].soil, "clay");
}

TEST(BevameterTable, VaryingForceOverPressureIsRejected) {
  EXPECT_THAT([] { read("F_N,p_Pa,z_m\n1,1000,0.01\n2,1500,0.02\n3,1700,0.03\n"); },
              ThrowsMessage<InputError>(HasSubstr("no usable row")));
}

TEST(BevameterTable, UnloadedRowsAreRejectedWithTheirLine) {
  const BevameterTable table =
      read("plate_width_m,pressure_Pa,sinkage_m\n0.1,0,0.02\n0.1,5000,0.02\n0.1,5000,0\n");
  ASSERT_EQ(table.plates.size(), 1U);
  EXPECT_EQ(table.plates[0].readings.size(), 1U);
  ASSERT_EQ(table.rejected.size(), 2U);
  EXPECT_EQ(table.rejected[0].line, 2U);
  EXPECT_EQ(table.rejected[1].line, 4U);
}

TEST(BevameterTable, TableWithoutTestColumnsIsRejected) {
  EXPECT_THAT([] { read("load_N,slip\n80,0.3\n"); },
              ThrowsMessage<InputError>(HasSubstr("lacks the columns of a plate test or a shear test")));
}

}  // namespace bevameter_table_test
}  // namespace talus::terramech
