#include <cmath>

#include <gtest/gtest.h>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "made_rows.hpp"

namespace talus::terramech {

namespace trial_test {

constexpr double kMissing = WheelState::kUnknown;

// Rows of two wheels, with the load `front_N` of the front wheel, at three moments on increasing slopes.
Telemetry drive(double front_N, double pull_N = kMissing) {
  Telemetry t;
  t.source = "drive.csv";
  t.numbers = {{"load_N", {}},         {"slip", {}},          {"sinkage_m", {}},
               {"slope_rad", {}},      {"time_s", {}},        {"pass_index", {}},
               {"wheel_radius_m", {}}, {"wheel_width_m", {}}, {"drawbar_pull_N", {}}};
  t.words = {{"run", {}}, {"wheel", {}}};
  for (int moment = 0; moment < 3; ++moment)
    for (int wheel = 0; wheel < 2; ++wheel) {
      const std::vector<double> row{wheel == 0 ? front_N : 100.0,
                                    0.1 + 0.05 * moment,
                                    0.01,
                                    0.05 * (moment + 1),
                                    10.0 * moment,
                                    1.0 + wheel,
                                    0.1,
                                    0.1,
                                    pull_N};
      for (std::size_t k = 0; k < row.size(); ++k) t.numbers[k].values.push_back(row[k]);
      t.words[0].values.push_back("one");
      t.words[1].values.push_back(wheel == 0 ? "front" : "rear");
      t.lines.push_back(t.lines.size() + 2);
    }
  return t;
}

TEST(Trial, RoverDrawbarPullEqualsTangentOfSlope) {
  const Trial trial = makeTrial(drive(80.0), RefinedModel{});
  ASSERT_EQ(trial.moment, (std::vector<int>{0, 0, 1, 1, 2, 2}));
  EXPECT_EQ(trial.run, trial.moment);
  for (int row = 0; row < 6; ++row) {
    // Closed form: steady motion, sum(DP) = tan(slope) sum(W), in the row of the first wheel of each moment.
    if (row % 2 == 0)
      EXPECT_NEAR(trial.measured(row, 0), std::tan(0.05 * (row / 2 + 1)), 1e-15);
    else
      EXPECT_TRUE(std::isnan(trial.measured(row, 0)));
  }
  // The slope, from which the pull was computed, is not a covariate.
  EXPECT_EQ(std::count(trial.covariates.begin(), trial.covariates.end(), "slope_rad"), 0);
  EXPECT_EQ(std::count(trial.covariates.begin(), trial.covariates.end(), "pass_index"), 1);
}

TEST(Trial, ColumnOfWhichAReadingIsComputedIsNoCovariate) {
  // Property: a motor current from which the torque was computed is no covariate; one measured with an error
  // of its own is.
  std::vector<std::string> columns = wheelColumns();
  columns.insert(columns.end(), {"current_A", "measured_A"});
  MadeRows rows(columns);
  std::mt19937_64 random(4);
  std::normal_distribution<double> error(1.0, 0.01);
  for (int k = 0; k < 30; ++k) {
    std::vector<double> row = wheelRow(madeSand(), 50.0 + k, 0.1 + 0.02 * k, 0.02, random);
    const double current = 0.4 + row[2] / 2.5;
    row.insert(row.end(), {1e-4 * std::round(1e4 * current), current * error(random)});
    rows.add(row);
  }
  RefinedModel model;
  model.soil = madeSand();
  EXPECT_EQ(makeTrial(rows.telemetry(), model).covariates,
            (std::vector<std::string>{"slip", "load_N", "measured_A"}));
}

TEST(Trial, ModelledRoverPullSumsAllWheels) {
  const Trial trial = makeTrial(drive(60.0), RefinedModel{});
  RefinedModel model;
  model.soil = {
      .cohesion_Pa = 800.0, .friction_angle_rad = 0.5, .frictional_modulus = 1e6, .shear_modulus_m = 0.015};
  SolvedContacts solved;
  const Eigen::MatrixXd level = predictRows(model, trial, solved);
  for (int row = 0; row < 6; row += 2) {
    const auto r = static_cast<std::size_t>(row);
    const double pull_N =
        predict(model, trial.states[r]).drawbar_pull_N + predict(model, trial.states[r + 1]).drawbar_pull_N;
    EXPECT_NEAR(level(row, 0), pull_N / 160.0, 1e-9);  // Closed form: each wheel alone
    EXPECT_NEAR(level(row, 1), predict(model, trial.states[r]).sinkage_m / 0.1, 1e-9);
  }
}

TEST(Trial, RoverPullIsNanIfAWheelIsMissing) {
  const Trial part = subset(makeTrial(drive(80.0), RefinedModel{}), {1, 1, 1, 0, 1, 1});
  EXPECT_TRUE(std::isfinite(part.measured(0, 0)));
  EXPECT_TRUE(std::isnan(part.measured(2, 0)));
  EXPECT_TRUE(std::isfinite(part.measured(3, 0)));
}

TEST(Trial, RowsNotFromADriveHaveNoMoments) {
  EXPECT_TRUE(makeTrial(drive(80.0, 5.0), RefinedModel{}).moment.empty());  // the pull is measured
  Telemetry same = drive(80.0);
  same.words[1].values.assign(6, "front");  // several rows of one wheel at one time
  EXPECT_TRUE(makeTrial(same, RefinedModel{}).moment.empty());
  Telemetry unnamed = drive(80.0);
  unnamed.words.pop_back();
  EXPECT_TRUE(makeTrial(unnamed, RefinedModel{}).moment.empty());
}

TEST(Trial, BeyondAxleIsSinkageAtOrAboveRadius) {
  MadeRows rows(wheelColumns());
  for (const double z : {0.05, 0.0999, 0.1, 0.15}) rows.add({60.0, 0.2, 2.0, z, 5.0, 0.1, 0.1});
  rows.add({60.0, 0.2, 2.0, std::nan(""), 5.0, 0.1, 0.1});
  // Closed form: z >= r = 0.1 m.
  EXPECT_EQ(beyondAxle(makeTrial(rows.telemetry(), {})), (std::vector<char>{0, 0, 1, 1, 0}));
}

}  // namespace trial_test

namespace model_rows_test {

constexpr double kNone = WheelState::kUnknown;

/// Rows of a wheel of radius 0.1 m: load, slip, sinkage, side force, slip angle.
Telemetry table() {
  MadeRows rows(
      {"load_N", "slip", "sinkage_m", "side_force_N", "slip_angle_rad", "wheel_radius_m", "wheel_width_m"});
  for (const auto& [sinkage_m, force_N, angle_rad] :
       {std::tuple{0.01, kNone, kNone}, std::tuple{0.02, 5.0, kNone}, std::tuple{0.01, 5.0, 0.2},
        std::tuple{0.12, kNone, kNone}, std::tuple{0.01, 0.0, kNone}})
    rows.add({50.0, 0.2, sinkage_m, force_N, angle_rad, 0.1, 0.1});
  return rows.telemetry();
}

TEST(ModelRows, SideForceRequiresSlipAngle) {
  const ModelRows rows = modelRows(table(), {});
  ASSERT_EQ(rows.rejected.size(), 1U);
  EXPECT_EQ(rows.rejected[0].line, 3U);
  EXPECT_THAT(rows.rejected[0].reason, testing::HasSubstr("side_force_N = 5 without slip_angle_rad"));
}

TEST(ModelRows, RowsBeyondTheAxleAreSeparated) {
  const ModelRows rows = modelRows(table(), {});
  EXPECT_EQ(rows.trial.rows(), 3);
  ASSERT_EQ(rows.beyond_axle.rows(), 1);
  EXPECT_NEAR(rows.beyond_axle.measured(0, 1), 1.2, 1e-12);
}

TEST(ModelRows, WheelComesFromTheRoverAndSoilIsUnknownWithoutName) {
  const ModelFile none = baseModel("", "");
  EXPECT_FALSE(none.soil_given);
  EXPECT_FALSE(none.model.wheel);
  const ModelFile sand = baseModel("sand", "fido");
  EXPECT_TRUE(sand.soil_given);
  ASSERT_TRUE(sand.model.wheel);
  EXPECT_EQ(sand.model.wheel->radius_m, loadRover("fido").wheel.radius_m);
}

}  // namespace model_rows_test

}  // namespace talus::terramech
