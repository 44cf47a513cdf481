#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <talus/terramech/calibration/table/prediction_table.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

#include "made_rows.hpp"
#include "temporary_file.hpp"

namespace talus::terramech {
namespace prediction_table_test {

using testing::HasSubstr;

RefinedModel refined() {
  RefinedModel model;
  model.soil = madeSand();
  model.noise.slip_relative = 0.03;
  return model;
}

PredictionTable predicted(const std::string& content) {
  const test::TemporaryFile file{content};
  return predictTable(file.path(), refined());
}

TEST(PredictionTable, PredictionsAreIndependentOfMeasuredColumns) {
  const std::string head = "load_N,slip,drawbar_pull_N,sinkage_m,torque_Nm,wheel_radius_m,wheel_width_m\n";
  const auto tail = [](const std::string& text) { return text.substr(text.find("0.1,0.1,")); };
  const auto honest = predicted(head + "80,0.3,5,0.01,2,0.1,0.1\n");
  const auto absurd = predicted(head + "80,0.3,nan,,-7e9,0.1,0.1\n");
  EXPECT_EQ(honest.predicted, 1U);
  EXPECT_EQ(tail(honest.text), tail(absurd.text));
  EXPECT_THAT(honest.text,
              HasSubstr("predicted_drawbar_pull_N,predicted_drawbar_pull_N_std,predicted_sinkage_m"));
}

TEST(PredictionTable, UnpredictableRowsKeepTheirPosition) {
  const auto table =
      predicted("load_N,slip,wheel_radius_m,wheel_width_m\n80,,0.1,0.1\n-2,0.3,0.1,0.1\n80,0.3,0.1,0.1\n");
  EXPECT_EQ(table.predicted, 1U);
  ASSERT_EQ(table.refused.size(), 2U);
  EXPECT_EQ(table.refused[0].line, 2U);
  EXPECT_THAT(table.refused[1].reason, HasSubstr("load_N must be > 0"));
  EXPECT_EQ(std::count(table.text.begin(), table.text.end(), '\n'), 4);
  EXPECT_THAT(table.text, HasSubstr("80,,0.1,0.1,,,,,,,,,\n"));
}

TEST(PredictionTable, RowWithoutTheColumnOfAnEffectIsRefused) {
  RefinedModel model = refined();
  model.effects = {{.name = "drift_torque_zero", .covariate = "time_s", .channel = Channel::Torque}};
  for (const EffectParameter& p : findEffect("drift_torque_zero")->parameters)
    model.effects[0].parameters.push_back(p.typical);
  const test::TemporaryFile file{
      "load_N,slip,time_s,wheel_radius_m,wheel_width_m\n80,0.3,5,0.1,0.1\n80,0.3,,0.1,0.1\n"};
  const PredictionTable table = predictTable(file.path(), model);
  EXPECT_EQ(table.predicted, 1U);
  ASSERT_EQ(table.refused.size(), 1U);
  EXPECT_EQ(table.refused[0].line, 3U);
  EXPECT_EQ(table.refused[0].reason, "time_s is missing, on which drift_torque_zero of the model depends");
}

TEST(PredictionTable, PredictionForPlainSoilIsTheEquilibrium) {
  const PredictionTable table = predicted("load_N,slip,wheel_radius_m,wheel_width_m\n80,0.3,0.1,0.1\n");
  const WheelForces f =
      equilibrium(madeSand(), Wheel{.radius_m = 0.1, .width_m = 0.1}, {.load_N = 80.0, .slip = 0.3});
  double pull = 0.0, pull_std = 0.0, sinkage = 0.0, sinkage_std = 0.0, torque = 0.0;
  const std::string row = table.text.substr(table.text.find('\n') + 1);
  ASSERT_EQ(std::sscanf(row.c_str(), "80,0.3,0.1,0.1,%lf,%lf,%lf,%lf,%lf", &pull, &pull_std, &sinkage,
                        &sinkage_std, &torque),
            5);
  // Property: two integrators of one model agree. Tolerance: 1e-6 of the load.
  EXPECT_NEAR(pull, f.drawbar_pull_N, 1e-6 * 80.0);
  EXPECT_NEAR(sinkage, f.sinkage_m, 1e-6 * f.sinkage_m);
  EXPECT_NEAR(torque, f.torque_Nm, 1e-6 * 8.0);
  EXPECT_GT(pull_std, 0.0);
}

TEST(PredictionTable, RowOutsideTrainingRangeIsFlaggedWithLargerStd) {
  const test::TemporaryFile file{
      "load_N,slip,wheel_radius_m,wheel_width_m\n80,0.3,0.1,0.1\n80,0.6,0.1,0.1\n"};
  const auto stdOf = [&](double high, std::string& flag) {
    const TrainedRange slip{.column = "slip", .low = 0.0, .high = high, .above = {0.5, 0.0, 0.0, 0.0}};
    const PredictionTable table = predictTable(file.path(), refined(), {.trained = {slip}});
    flag = table.text.substr(table.text.rfind(',') + 1);
    const std::string row = table.text.substr(table.text.find("80,0.6"));
    double pull_std = 0.0;
    EXPECT_EQ(std::sscanf(row.c_str(), "80,0.6,0.1,0.1,%*f,%lf", &pull_std), 1);
    EXPECT_EQ(table.outside, high < 0.6 ? 1U : 0U);
    return pull_std / 80.0;
  };
  std::string inside, outside;
  const double plain = stdOf(1.0, inside), widened = stdOf(0.4, outside);
  EXPECT_EQ(inside, "\n");
  EXPECT_EQ(outside, "slip\n");
  EXPECT_NEAR(widened, std::hypot(plain, 0.5 * 0.2), 1e-9);  // Closed form: distance 0.2 times a growth of
                                                             // 0.5 per unit
}

TEST(PredictionTable, BeyondScopePredictionIsTheBaseWithTheDifferenceInItsStd) {
  const test::TemporaryFile file{"load_N,slip,wheel_radius_m,wheel_width_m\n80,0.6,0.1,0.1\n"};
  RefinedModel model = refined();
  model.effects = {
      {.name = "slip_sinkage_linear", .covariate = "slip", .channel = Channel::Sinkage, .parameters = {1.0}}};
  const auto sinkageOf = [&](const RefinedModel& m, const ModelScope& scope) {
    const std::string text = predictTable(file.path(), m, scope).text;
    Estimate z;
    EXPECT_EQ(
        std::sscanf(text.c_str() + text.find("80,0.6"), "80,0.6,0.1,0.1,%*f,%*f,%lf,%lf", &z.value, &z.std),
        2);
    return z;
  };
  ModelScope scope{.trained = {{.column = "slip", .low = 0.0, .high = 0.3}}, .base = refined()};
  scope.trained[0].reach_above = {0.1, 0.1, 0.1, 0.1};
  const Estimate base = sinkageOf(refined(), {}), own = sinkageOf(model, {}), far = sinkageOf(model, scope);
  EXPECT_NEAR(far.value, base.value, 1e-9 * base.value);
  EXPECT_NEAR(far.std, std::hypot(own.std, own.value - base.value), 1e-9);  // Closed form
}

TEST(PredictionTable, EarlierPredictionsAreReplacedAndOtherColumnsKept) {
  const PredictionTable table = predicted(
      "predicted_sinkage_m,note,load_N,slip,wheel_radius_m,wheel_width_m\n9,\"a,b\",80,0.3,0.1,0.1\n");
  EXPECT_TRUE(table.replaced);
  EXPECT_THAT(table.text, HasSubstr("\"a,b\",80,0.3,0.1,0.1,"));
  EXPECT_EQ(table.text.find("predicted_sinkage_m,"), table.text.rfind("predicted_sinkage_m,"));
}

}  // namespace prediction_table_test
}  // namespace talus::terramech
