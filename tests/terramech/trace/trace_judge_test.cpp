#include <optional>

#include <talus/terramech/trace/residual_trace.hpp>
#include <talus/terramech/trace/trace_search.hpp>

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

Explanation explanation(const char* name, double score, double gain, int parameters = 1) {
  Explanation e;
  e.candidate = {{{.name = name, .covariate = "slip"}}, "family", parameters};
  e.score = e.in_sample = score;
  e.chi2_gain = gain;
  return e;
}

// Which of ranked explanations is taken for thirty rows of one reading.
std::optional<std::size_t> chosen(const std::vector<Explanation>& ranked) {
  RefinedModel base;
  base.soil = madeSand();
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(1);
  for (int k = 0; k < 30; ++k) rows.add(wheelRow(base.soil, 50.0 + k, 0.1 + 0.02 * k, 0.02, random));
  return TraceSearch(base, makeTrial(rows.telemetry(), base), {}).choose(ranked);
}

// Closed form: what traceResiduals() promises of its choice, at either side of each bound.
TEST(TraceJudge, OnlyWhatPaysIsChosen) {
  EXPECT_EQ(chosen({}), std::nullopt);
  EXPECT_EQ(chosen({explanation("bulldozing", 1.9, 50.0)}), std::nullopt);
  EXPECT_EQ(chosen({explanation("bulldozing", 2.1, 50.0)}), 0U);
  Explanation spoiler = explanation("bulldozing", 9.0, 50.0);
  spoiler.spoils = true;
  EXPECT_EQ(chosen({spoiler, explanation("rear_pile", 5.0, 40.0)}), 1U);
}

TEST(TraceJudge, AKnownFormGoesBeforeACurveThatDoesHardlyMore) {
  const Explanation curve = explanation("empirical", 20.0, 100.0, 4);
  EXPECT_EQ(chosen({curve, explanation("bulldozing", 10.0, 92.0)}), 0U);
  EXPECT_EQ(chosen({curve, explanation("bulldozing", 10.0, 94.0)}), 1U);
}

TEST(TraceJudge, AFurtherParameterMustCarryAShare) {
  const Explanation wide = explanation("rear_pile", 20.0, 100.0, 2);
  EXPECT_EQ(chosen({wide, explanation("bulldozing", 18.0, 94.0)}), 0U);
  EXPECT_EQ(chosen({wide, explanation("bulldozing", 18.0, 96.0)}), 1U);
}

}  // namespace
}  // namespace talus::terramech
