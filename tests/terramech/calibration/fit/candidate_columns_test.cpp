#include <talus/terramech/calibration/search/trace_search.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace candidate_columns_test {

/// Rows of the synthetic sand whose torque readings are multiplied by `share`.
Trial rowsWithTorque(double share) {
  MadeRows rows(wheelColumns());
  std::mt19937_64 random(6);
  for (int k = 0; k < 80; ++k) {
    std::vector<double> row =
        wheelRow(madeSand(), 50.0 + (k * 7) % 60, 0.05 + 0.05 * ((k * 11) % 16), 0.02, random);
    row[2] *= share;
    rows.add(row);
  }
  RefinedModel model;
  model.soil = madeSand();
  return makeTrial(rows.telemetry(), model);
}

double gainOfEfficiency(double share) {
  RefinedModel model;
  model.soil = madeSand();
  TraceSearch search(model, rowsWithTorque(share), {});
  const EffectForm& form = *findEffect("torque_efficiency");
  const Effect effect{.name = form.name,
                      .covariate = form.covariate,
                      .channel = form.channel,
                      .parameters = {form.parameters.front().typical}};
  return search.gainsOf({{{effect}, form.family, 1}}).front();
}

// Property: the range of the factor eta, 0.3 to 2, allows torque readings that are too low and too high.
TEST(CandidateColumns, AFactorGainsInEitherSense) {
  EXPECT_GT(gainOfEfficiency(1.15), 20.0);
  EXPECT_GT(gainOfEfficiency(0.87), 20.0);
}

}  // namespace candidate_columns_test
}  // namespace talus::terramech
