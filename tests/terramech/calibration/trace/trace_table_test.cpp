#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/trace/residual_trace.hpp>

#include "made_rows.hpp"
#include "temporary_file.hpp"

namespace talus::terramech {
namespace trace_table_test {

/// Forty rows of the synthetic sand with a torque offset of 0.8 Nm; one row sunk to the axle, two rows with a
/// side force but no slip angle.
Telemetry table() {
  std::vector<std::string> columns = wheelColumns();
  columns.insert(columns.end(), {"side_force_N", "slip_angle_rad"});
  MadeRows rows(columns);
  std::mt19937_64 random(6);
  for (int k = 0; k < 43; ++k) {
    std::vector<double> row =
        wheelRow(madeSand(), 40.0 + (k * 7) % 80, 0.05 + 0.05 * ((k * 11) % 16), 0.02, random);
    row[2] += 0.8;
    if (k == 5) row[3] = 0.11;
    row.insert(row.end(), {k == 10 || k == 30 ? 6.0 : WheelState::kUnknown, WheelState::kUnknown});
    rows.add(row);
  }
  return rows.telemetry();
}

ModelFile base() {
  ModelFile sand;
  sand.model.soil = madeSand();
  return sand;
}

class TraceTable : public testing::Test {
 protected:
  static void SetUpTestSuite() { trace_ = new TableTrace(traceTable(table(), {.base = base()})); }
  static void TearDownTestSuite() {
    delete trace_;
    trace_ = nullptr;
  }
  static inline TableTrace* trace_ = nullptr;
};

TEST_F(TraceTable, EveryRowIsUsedOrReported) {
  EXPECT_EQ(trace_->rowsUsed(), 40);
  ASSERT_EQ(trace_->rejected.size(), 2U);
  EXPECT_EQ(trace_->rejected[0].line, 12U);
  EXPECT_EQ(trace_->beyond_axle, 1);
  // Property: the row sunk to the axle has z/r = 1.1, and the model predicts about 0.1.
  EXPECT_GT(trace_->beyond_axle_rmse[1], 0.5);
}

TEST_F(TraceTable, SensorFaultIsIdentifiedAndExplains) {
  ASSERT_EQ(trace_->result.effects.size(), 1U);
  EXPECT_EQ(trace_->result.effects[0].chosen.candidate.family, "torque_sensor");
  EXPECT_EQ(trace_->answer.verdict, Verdict::Explained);
  EXPECT_TRUE(trace_->applies.applies);
}

TEST_F(TraceTable, HeldOutErrorsListTheSearchFirst) {
  ASSERT_GE(trace_->held_out.size(), 1U);
  EXPECT_EQ(trace_->held_out[0].scheme, trace_->result.held_out.scheme);
  EXPECT_EQ(trace_->held_out[0].refined_rmse[1], trace_->result.held_out.refined_rmse[1]);
}

// Property: the written model file is read back without any change.
TEST_F(TraceTable, ModelFileRoundTrips) {
  const test::TemporaryFile file{trace_->modelText()};
  const ModelFile read = loadModel(file.path());
  EXPECT_EQ(modelText(read.model, read.scope), trace_->modelText());
  ASSERT_EQ(read.model.effects.size(), 1U);
  EXPECT_EQ(read.model.effects[0].parameters, trace_->result.refined.effects[0].parameters);
}

// Property: rows that the reader rejects do not change the result.
TEST(ReadTraceTable, RejectsRowsThatTracingRejects) {
  const test::TemporaryFile file{
      "load_N,slip,sinkage_m,side_force_N,wheel_radius_m,wheel_width_m\n"
      "50,0.2,0.01,,0.1,0.1\n50,0.2,0.01,4,0.1,0.1\n-3,0.2,0.01,,0.1,0.1\n"};
  const Telemetry read = readTraceTable(file.path());
  EXPECT_EQ(read.size(), 1U);
  ASSERT_EQ(read.rejected.size(), 2U);
  EXPECT_THAT(read.rejected[1].reason, testing::HasSubstr("without slip_angle_rad"));
}

}  // namespace trace_table_test
}  // namespace talus::terramech
