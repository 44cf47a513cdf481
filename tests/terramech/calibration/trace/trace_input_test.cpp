#include <talus/common/input_error.hpp>
#include <talus/terramech/calibration/trace/trace_input.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace trace_input_test {

Telemetry table(int count) {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(3);
  for (int k = 0; k < count; ++k) rows.add(wheelRow(madeSand(), 50.0, 0.1 + 0.02 * k, 0.02, random));
  return rows.telemetry();
}

TEST(TraceInput, GivenSoilGetsDefaultStdAndUnknownSoilIsFitted) {
  ModelFile given;
  given.model.soil = madeSand();
  const TraceInput of_given = traceInput(table(12), given, {.significance = 0.1, .seed = 7});
  EXPECT_FALSE(of_given.options.fit_soil);
  EXPECT_FALSE(of_given.rows.model.soil_prior_std.empty());
  EXPECT_EQ(of_given.options.significance, 0.1);
  EXPECT_EQ(of_given.options.seed, 7U);
  const TraceInput of_unknown = traceInput(table(12), unknownSoil(), {});
  EXPECT_TRUE(of_unknown.options.fit_soil);
  EXPECT_EQ(of_unknown.rows.model.soil_prior_std, unknownSoil().model.soil_prior_std);
}

TEST(TraceInput, FewerThanFiveRowsAreRejected) {
  EXPECT_EQ(traceInput(table(5), unknownSoil(), {}).rows.trial.rows(), 5);
  EXPECT_THAT([] { traceInput(table(4), unknownSoil(), {}); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr(
                  "made: 4 usable rows with sinkage below the wheel radius; tracing needs at least 5")));
}

}  // namespace trace_input_test
}  // namespace talus::terramech
