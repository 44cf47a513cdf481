#include <cmath>
#include <random>

#include <talus/terramech/calibration/tables/soil_groups.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

#include "calibration/wheel_table.hpp"

namespace talus::terramech {
namespace soil_groups_test {

using testing::HasSubstr;

// Thirty rows in three groups of the column "box", and a column "run" without effect. The torque readings of
// box B are higher by `share`; each torque has an error of 5 %.
WheelRows rowsOf(double share) {
  WheelRows rows;
  rows.words = {{"run", {}}, {"box", {}}};
  std::mt19937_64 random(11);
  std::normal_distribution<double> error(1.0, 0.05);
  for (int k = 0; k < 30; ++k) {
    const WheelOperation at = madeOperation(k % 12);
    const WheelForces f = equilibrium(kMadeSoil, kMadeWheel, at);
    const double more = k % 3 == 1 ? 1.0 + share : 1.0;
    rows.samples.push_back({at.load_N, f.torque_Nm * more * error(random), f.sinkage_m, at.slip});
    rows.wheels.push_back(kMadeWheel);
    rows.words[0].values.push_back(k < 15 ? "one" : "two");
    rows.words[1].values.push_back(std::string(1, static_cast<char>('A' + k % 3)));
  }
  return rows;
}

SoilPosterior truth() {
  SoilPosterior p;
  p.mean.cohesion_Pa = kMadeSoil.cohesion_Pa;
  p.mean.friction_angle_rad = kMadeSoil.friction_angle_rad;
  p.mean.sinkage_exponent = kMadeSoil.sinkage_exponent;
  p.mean.sinkage_modulus = kMadeSoil.frictional_modulus;
  p.mean.shear_modulus_m = kMadeSoil.shear_modulus_m;
  p.mean.c1 = kMadeSoil.c1;
  p.mean.c2 = kMadeSoil.c2;
  return p;
}

TEST(SoilGroups, RowsOfOneSoilShowNoGroupDisagreement) {
  EXPECT_EQ(groupsThatDisagree(rowsOf(0.0), truth(), ReadingErrors::relative(0.05)), "");
}

TEST(SoilGroups, DisagreeingColumnAndGroupAreNamed) {
  const std::string said = groupsThatDisagree(rowsOf(0.4), truth(), ReadingErrors::relative(0.05));
  EXPECT_THAT(said, HasSubstr("all values of box"));
  EXPECT_THAT(said, HasSubstr("box = B"));
}

TEST(SoilGroups, ColumnWithOneRowPerGroupIsIgnored) {
  WheelRows rows = rowsOf(0.4);
  rows.words = {{"note", {}}};
  for (int k = 0; k < 30; ++k) rows.words[0].values.push_back(std::to_string(k));
  EXPECT_EQ(groupsThatDisagree(rows, truth(), ReadingErrors::relative(0.05)), "");
}

}  // namespace soil_groups_test
}  // namespace talus::terramech
