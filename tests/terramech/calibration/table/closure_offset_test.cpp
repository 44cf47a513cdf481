
#include <talus/terramech/calibration/table/closure_offset.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace closure_offset_test {

Soil sand(double cohesion_Pa, double friction_rad) {
  return {.name = "sand",
          .cohesion_Pa = cohesion_Pa,
          .friction_angle_rad = friction_rad,
          .sinkage_exponent = 1.0,
          .frictional_modulus = 1.2e6,
          .shear_modulus_m = 0.015};
}

/// Rows of two sources on two soils. The force sensor of the second source has the offset `offset` times the
/// load.
Trial twoSources(double offset) {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random{5};
  for (int k = 0; k < 8; ++k) {
    const double slip = 0.1 + 0.08 * k;
    rows.add(wheelRow(sand(300.0, 0.6), 60.0, slip, 0.02, random), "a");
    std::vector<double> row = wheelRow(sand(2000.0, 0.45), 45.0, slip, 0.02, random);
    row[4] += offset * row[0];
    rows.add(row, "b");
  }
  return makeTrial(rows.telemetry("source"), RefinedModel{});
}

TEST(ClosureOffset, FindsTheSourceAndSizeOfTheOffset) {
  for (const double offset : {-0.18, 0.1}) {
    const auto found = findClosureOffset(twoSources(offset), 1);
    ASSERT_TRUE(found.has_value()) << offset;
    EXPECT_EQ(found->value, "b");
    EXPECT_LE(found->p_value, 0.01);
    // Property: the true offset lies within two standard deviations of the estimate.
    EXPECT_NEAR(found->offset, offset, 2.0 * found->std);
    EXPECT_LT(found->std, 0.03);
  }
}

TEST(ClosureOffset, DifferentSoilsYieldNoOffset) {
  EXPECT_FALSE(findClosureOffset(twoSources(0.0), 1).has_value());
}

TEST(ClosureOffset, ClosureRelationIsValidForAnySoil) {
  // Property: the relation has the stated accuracy relative to the integrated forces, over a grid of soils
  // and slips.
  std::mt19937_64 random{6};
  MadeRows rows(wheelColumns());
  for (const double friction : {0.35, 0.5, 0.65})
    for (const double cohesion : {0.0, 1000.0, 3000.0})
      for (const double slip : {0.1, 0.3, 0.6})
        rows.add(wheelRow(sand(cohesion, friction), 50.0, slip, 0.0, random));
  for (const double error : closureErrors(makeTrial(rows.telemetry(), RefinedModel{})))
    EXPECT_LT(std::abs(error), 0.03);
}

}  // namespace closure_offset_test
}  // namespace talus::terramech
