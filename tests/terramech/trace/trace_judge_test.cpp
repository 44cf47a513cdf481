#include <talus/terramech/trace/residual_trace.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace {

// Columns that the found effects name, for rows of five boxes whose pull is off by turns; `datum_m`: error of
// the sinkage's zero.
std::vector<std::string> causesInBoxes(double datum_m) {
  RefinedModel base;
  base.soil = madeSand();
  std::vector<std::string> columns = wheelColumns();
  columns.emplace_back("box");
  MadeRows rows(columns);
  std::mt19937_64 random(3);
  for (int k = 0; k < 100; ++k) {
    const int box = (k * 7) % 5;
    std::vector<double> row = wheelRow(base.soil, 50.0 + k % 30, 0.1 + 0.05 * (k % 12), 0.02, random);
    row[3] += datum_m;
    row[4] += (box % 2 == 0 ? 0.06 : -0.06) * row[0];
    row.push_back(box);
    rows.add(row);
  }
  std::vector<std::string> causes;
  for (const TracedEffect& e :
       traceResiduals(base, makeTrial(rows.telemetry(), base), {.flips = 499}).effects)
    causes.push_back(e.chosen.candidate.covariate());
  return causes;
}

TEST(TraceJudge, AFurtherCurveMustTellLevelsThatItHasNotSeen) {
  // No curve over the boxes' number foretells the sixth: alone it is told all the same, since the boxes do
  // differ; beside a known effect it is not taken for a part of the model.
  EXPECT_THAT(causesInBoxes(0.0), ::testing::ElementsAre("box"));
  EXPECT_THAT(causesInBoxes(0.02), ::testing::ElementsAre("constant"));
}

}  // namespace
}  // namespace talus::terramech
