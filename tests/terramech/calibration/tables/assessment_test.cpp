#include <cmath>
#include <stdexcept>

#include <refused.hpp>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration.hpp>

#include "calibration/wheel_table.hpp"

namespace talus::terramech {
namespace assessment_test {

WheelForces forcesOf(std::size_t line) {
  return equilibrium(kMadeSoil, kMadeWheel, madeOperation(static_cast<int>(line) - 2));
}

TEST(Assessment, DrawbarPullOfEachRowMatchesTheModel) {
  const WheelTable table;
  const AssessedTable assessed = assessTable({.table = table.path()}, {});
  ASSERT_EQ(assessed.rows.size(), 12U);
  for (const Assessment& row : assessed.rows) {
    const double load_N = madeOperation(static_cast<int>(row.line) - 2).load_N;
    // Tolerance: our estimator's error is 0.002 to 0.007 (drawbar_pull.hpp).
    EXPECT_NEAR(row.pull.value, forcesOf(row.line).drawbar_pull_N / load_N, 0.01);
    EXPECT_NEAR(row.torque_over_load_radius, forcesOf(row.line).torque_Nm / (load_N * 0.15), 1e-12);
    EXPECT_NEAR(row.sinkage_over_radius.value, forcesOf(row.line).sinkage_m / 0.15, 1e-12);
    EXPECT_NEAR(row.sinkage_over_radius.std, 0.05 * row.sinkage_over_radius.value, 1e-12);
    EXPECT_FALSE(row.forecast);
  }
}

TEST(Assessment, SoilModelPredictsItsOwnPull) {
  const WheelTable table;
  const test::TemporaryFile model{kMadeSoilText, ".yaml"};
  const AssessedTable assessed = assessTable({.table = table.path(), .model = model.path()}, {});
  ASSERT_EQ(assessed.rows.size(), 12U);
  for (const Assessment& row : assessed.rows) {
    const double load_N = madeOperation(static_cast<int>(row.line) - 2).load_N;
    EXPECT_NEAR(row.pull.value, forcesOf(row.line).drawbar_pull_N / load_N, 1e-6);
  }
}

// Closed form: a sinkage above the threshold lowers the category by one; above the critical value the
// category is dangerous.
TEST(Assessment, SinkageAboveThresholdsLowersTheCategory) {
  const WheelTable table;
  const auto category = [&](double threshold, double critical) {
    return assessTable(
               {.table = table.path(), .slope_rad = 0.0, .z_threshold = threshold, .z_critical = critical},
               {})
        .rows.back()
        .category;
  };
  ASSERT_EQ(category(0.9, 0.95), Category::Safe);
  EXPECT_EQ(category(1e-6, 0.95), Category::Marginal);
  EXPECT_EQ(category(1e-6, 2e-6), Category::Dangerous);
}

TEST(Assessment, ForecastAtReferenceSlipIsAccurate) {
  const WheelTable table;
  const AssessedTable assessed = assessTable({.table = table.path(), .noise = 0.01, .extrapolate = true}, {});
  for (const Assessment& row : assessed.rows) {
    ASSERT_TRUE(row.forecast);
    const double load_N = madeOperation(static_cast<int>(row.line) - 2).load_N;
    const WheelForces at = equilibrium(kMadeSoil, kMadeWheel, {.load_N = load_N, .slip = 0.5});
    EXPECT_NEAR(row.forecast->at_reference.value, at.drawbar_pull_N / load_N, 0.02);
  }
}

// Property: readings of a smooth wheel determine the pull at the reference slip, whatever lugs the rover file states.
TEST(Assessment, LugsOfTheRoverAreCountedOnceInAForecast) {
  const WheelTable table;
  const auto at_reference = [&](const std::string& lugs) {
    const test::TemporaryFile rover{
        "{name: lugs, mass_kg: 80, gravity_m_s2: 9.81, wheelbase_m: 1.2, track_m: 1.0, clearance_m: 0.3, "
        "centre_of_mass_height_m: 0.4, max_pitch_deg: 25, max_roll_deg: 25, max_torque_Nm: 45, "
        "max_speed_mps: 0.1, "
        "hotel_power_W: 50, steering: skid, wheels: {count: 6, radius_m: 0.15, width_m: 0.15" +
            lugs + "}}\n",
        ".yaml"};
    return assessTable({.table = table.path(), .rover = rover.path(), .noise = 0.01, .extrapolate = true}, {})
        .rows.front()
        .forecast->at_reference.value;
  };
  EXPECT_EQ(at_reference(", grouser_height_m: 0.02, grouser_count: 24, lug_thrust: 1.0"), at_reference(""));
}

TEST(Assessment, UnknownFormulaAndInvertedThresholdsAreRejected) {
  const WheelTable table;
  EXPECT_REFUSED(assessTable({.table = table.path(), .formula = "no-such"}, {}), std::invalid_argument,
                 "formula 'no-such' is unknown, must be single-force, small-angle, triangular or plane");
  EXPECT_REFUSED(assessTable({.table = table.path(), .z_threshold = 0.8, .z_critical = 0.5}, {}),
                 std::invalid_argument, "z_threshold = 0.800000, must be <= 0.500000");
  const test::TemporaryFile soilless{"model: wong-reece\n", ".yaml"};
  EXPECT_REFUSED(assessTable({.table = table.path(), .model = soilless.path()}, {}), InputError,
                 "defines no soil; fit one first");
  EXPECT_REFUSED(assessTable({.table = "no_such_table.csv"}, {}), InputError,
                 "no_such_table.csv: No such file or directory");
}

}  // namespace assessment_test
}  // namespace talus::terramech
