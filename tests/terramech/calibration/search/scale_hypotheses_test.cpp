#include <cmath>

#include <talus/terramech/calibration/search/scale_hypotheses.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace scale_hypotheses_test {

/// The scale of a table of the synthetic sand with 2 % errors, whose column number `column` is multiplied by
/// `factor`. The soil is known within 10 %.
std::optional<ScaledColumn> scaleOf(std::size_t column, double factor) {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(3);
  for (int k = 0; k < 80; ++k) {
    std::vector<double> row =
        wheelRow(madeSand(), 40.0 + (k * 7) % 80, 0.05 + 0.05 * ((k * 11) % 12), 0.02, random);
    row[column] *= factor;
    rows.add(row);
  }
  RefinedModel base;
  base.soil = madeSand();
  for (const auto& [name, mean] : {std::pair{"friction_angle_rad", base.soil.friction_angle_rad},
                                   {"frictional_modulus", base.soil.frictional_modulus}}) {
    base.soil_prior_mean[name] = mean;
    base.soil_prior_std[name] = 0.1 * mean;
  }
  const TraceResult result = traceResiduals(base, makeTrial(rows.telemetry(), base), {.max_effects = 0});
  return likelyScale(result, result.base, {});
}

TEST(ScaleHypotheses, ColumnInAnotherUnitIsNamedWithItsScale) {
  // Property: the table was multiplied by the inverse of the scale that is found.
  for (const auto& [column, name, scale] :
       {std::tuple{0U, "load_N", 9.81}, {2U, "torque_Nm", 0.5}, {4U, "drawbar_pull_N", 9.81}}) {
    const auto found = scaleOf(column, 1.0 / scale);
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(found->column, name);
    EXPECT_EQ(found->scale, scale);
  }
  EXPECT_EQ(scaleOf(0, 1.0 / 9.81)->text().substr(0, 42), "load_N looks like kilograms: scale 9.81 (l");
}

TEST(ScaleHypotheses, SoundTableHasNoScale) {
  EXPECT_FALSE(scaleOf(0, 1.0));
}

}  // namespace scale_hypotheses_test
}  // namespace talus::terramech
