#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <talus/terramech/calibration/tables/table_applicability.hpp>
#include <talus/terramech/effects/refined_model.hpp>

#include "temporary_file.hpp"

namespace talus::terramech {
namespace table_applicability_test {

/// A table of 60 rows: readings of a wheel on sand or, if shuffled, readings that no soil explains.
std::string tableOf(bool shuffled) {
  RefinedModel sand;
  sand.soil = {.cohesion_Pa = 800.0,
               .friction_angle_rad = 0.55,
               .sinkage_exponent = 1.0,
               .cohesive_modulus = 0.0,
               .frictional_modulus = 1e6,
               .shear_modulus_m = 0.015};
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  std::string text = "load_N,slip,torque_Nm,sinkage_m,drawbar_pull_N,wheel_radius_m,wheel_width_m\n";
  for (int k = 0; k < 60; ++k) {
    const WheelState s{.wheel = {.radius_m = 0.1, .width_m = 0.1},
                       .load_N = 50.0 + 5.0 * (k % 8),
                       .slip = 0.05 + 0.01 * (k % 50)};
    const Reading r = predict(sand, s);
    const double noise = 1.0 + 0.02 * normal(random);
    const double torque = shuffled ? std::abs(4.0 + 3.0 * normal(random)) : r.torque_Nm * noise;
    const double sinkage = shuffled ? std::abs(0.03 + 0.02 * normal(random)) : r.sinkage_m * noise;
    const double pull = shuffled ? 20.0 * normal(random) : r.drawbar_pull_N;
    for (const double v : {s.load_N, s.slip, torque, sinkage, pull, 0.1}) text += std::to_string(v) + ",";
    text += "0.1\n";
  }
  return text;
}

TEST(TableApplicability, ModelAppliesToWheelDataAndNotToOtherData) {
  const test::TemporaryFile sand{tableOf(false)}, other{tableOf(true)};
  EXPECT_TRUE(tableApplicability(sand.path(), "", "").applies);
  const Applicability none = tableApplicability(other.path(), "", "");
  EXPECT_FALSE(none.applies);
  EXPECT_FALSE(none.reason.empty());
}

TEST(TableApplicability, TableWithTooLittleDataIsAssumedApplicable) {
  const test::TemporaryFile few{"load_N,slip,sinkage_m,wheel_radius_m,wheel_width_m\n50,0.2,0.01,0.1,0.1\n"};
  EXPECT_TRUE(tableApplicability(few.path(), "", "").applies);
  const test::TemporaryFile bare{"slip,sinkage_m\n0.2,0.01\n"};
  EXPECT_TRUE(tableApplicability(bare.path(), "", "").applies);
}

}  // namespace table_applicability_test
}  // namespace talus::terramech
