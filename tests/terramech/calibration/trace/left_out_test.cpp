#include <algorithm>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/trace/left_out.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace left_out_test {

using testing::HasSubstr;

Trial trial() {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(3);
  for (int k = 0; k < 48; ++k)
    rows.add(wheelRow(madeSand(), 50.0 + 10.0 * (k % 3), 0.1 + 0.1 * (k % 4), 0.02, random),
             k % 2 ? "a" : "b");
  RefinedModel model;
  return makeTrial(rows.telemetry("wheel"), model);
}

long rowsIn(const LeftOut& part) {
  return std::count(part.rows.begin(), part.rows.end(), 1);
}

TEST(LeftOut, ColumnIsLeftOutLevelByLevel) {
  for (const auto& [column, levels] :
       {std::pair{"slip", 4U}, std::pair{"load_N", 3U}, std::pair{"wheel", 2U}}) {
    const auto all = leftOut(trial(), column, "t.csv");
    EXPECT_EQ(all.size(), levels) << column;
    long rows = 0;
    for (const LeftOut& part : all) rows += rowsIn(part);
    EXPECT_EQ(rows, 48) << column;
  }
}

TEST(LeftOut, ValuesAndRangesSelectTheirRows) {
  EXPECT_EQ(rowsIn(leftOut(trial(), "slip=0.2,0.4", "t.csv").front()), 24);
  EXPECT_EQ(rowsIn(leftOut(trial(), "slip=0.25..", "t.csv").front()), 24);
  EXPECT_EQ(rowsIn(leftOut(trial(), "wheel=a", "t.csv").front()), 24);
}

// Property: a level that contains a comma or a quote is one value, both in the loop over all levels and in
// quotes as a CSV field.
TEST(LeftOut, QuotedValueMayContainCommas) {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(3);
  const std::vector<std::string> wheels{"smooth, wide", "smooth", "5\" rim, old"};
  for (int k = 0; k < 48; ++k)
    rows.add(wheelRow(madeSand(), 50.0 + 10.0 * (k % 3), 0.1 + 0.1 * (k % 4), 0.02, random),
             wheels[static_cast<std::size_t>(k) % 3]);
  RefinedModel model;
  const Trial trial = makeTrial(rows.telemetry("wheel"), model);
  for (const LeftOut& part : leftOut(trial, "wheel", "t.csv")) EXPECT_EQ(rowsIn(part), 16) << part.what;
  EXPECT_EQ(rowsIn(leftOut(trial, "wheel=\"smooth, wide\"", "t.csv").front()), 16);
  EXPECT_EQ(rowsIn(leftOut(trial, "wheel=smooth,\"5\"\" rim, old\"", "t.csv").front()), 32);
  for (const char* open : {"wheel=\"smooth, wide", "wheel=\"smooth\"wide"})
    EXPECT_THAT([&] { leftOut(trial, open, "t.csv"); },
                testing::ThrowsMessage<InputError>(HasSubstr("does not end with a quote")));
}

// Property: two dots separate the ends of a numeric range, and are part of a text value.
TEST(LeftOut, TextValueMayContainTwoDots) {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(3);
  for (int k = 0; k < 48; ++k)
    rows.add(wheelRow(madeSand(), 50.0 + 10.0 * (k % 3), 0.1 + 0.1 * (k % 4), 0.02, random),
             k % 3 ? "1..2" : "3");
  RefinedModel model;
  const Trial trial = makeTrial(rows.telemetry("wheel"), model);
  EXPECT_EQ(rowsIn(leftOut(trial, "wheel=1..2", "t.csv").front()), 32);
}

TEST(LeftOut, EmptyOrCompleteSelectionIsRejected) {
  for (const auto& [request, reason] :
       {std::pair{"slop", "has no column slop"}, std::pair{"slip=0.9", "has no row with"},
        std::pair{"slip=0..1", "has only rows with"}, std::pair{"slip=low..0.3", "are no numbers"},
        std::pair{"slip=0.1..0.3x", "are no numbers"}})
    try {
      leftOut(trial(), request, "t.csv");
      ADD_FAILURE() << request;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), HasSubstr(reason));
    }
}

TEST(LeftOut, ErrorsAreThoseOfPredictingTheLeftOutRows) {
  RefinedModel base;
  base.soil = madeSand();
  const auto part = leftOut(trial(), "slip=0.2", "t.csv").front();
  const LeftOutErrors errors = traceWithout(base, trial(), part, {}, {});
  EXPECT_EQ(errors.rows, 12);
  // Property: with the true soil and no missing effect, no effect is found, and both models have the error of
  // the noise.
  EXPECT_TRUE(errors.effects.empty());
  EXPECT_EQ(errors.base[1], errors.refined[1]);
  EXPECT_LT(errors.refined[1], 2.0 * errors.floor[1]);
  // Property: the errors are those of the returned predictions.
  for (const auto& [predicted, rmse] :
       {std::pair{errors.base_predicted, errors.base}, std::pair{errors.predicted, errors.refined}})
    EXPECT_NEAR((errors.trial.measured - predicted).col(1).norm() / std::sqrt(12.0), rmse[1], 1e-12);
  // Property: a regression on columns without a wheel model is not better.
  EXPECT_GT(errors.regression[1], 0.5 * errors.refined[1]);
}

}  // namespace left_out_test
}  // namespace talus::terramech
