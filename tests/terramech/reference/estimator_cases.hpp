#pragma once

#include <vector>

#include <talus/terramech/contact/wheel_on_soil.hpp>

#include "reference_table.hpp"

namespace talus::terramech::test {

/// Ten readings of one soil, with the results of the linear estimators for each reading (rows) and for all
/// (results).
struct EstimatorCase {
  ReferenceRow results;
  std::vector<ReferenceRow> rows;
  std::vector<ReferenceRow> modulus_errors;

  Wheel wheel() const { return {.radius_m = results["radius_m"], .width_m = results["width_m"]}; }
  double shearModulus_m() const { return results["shear_modulus_m"]; }
};

inline WheelSample sampleOf(const ReferenceRow& row) {
  return {.load_N = row["load_N"],
          .torque_Nm = row["torque_Nm"],
          .sinkage_m = row["sinkage_m"],
          .slip = row["slip"]};
}

inline std::vector<WheelSample> samplesOf(const EstimatorCase& c) {
  std::vector<WheelSample> samples;
  for (const ReferenceRow& row : c.rows) samples.push_back(sampleOf(row));
  return samples;
}

inline std::vector<EstimatorCase> estimatorCases() {
  const auto samples = referenceTable("estimator_samples"), errors = referenceTable("modulus_errors");
  std::vector<EstimatorCase> cases;
  for (const ReferenceRow& results : referenceTable("estimator_results")) {
    const auto ofThisCase = [&](const std::vector<ReferenceRow>& all) {
      std::vector<ReferenceRow> rows;
      for (const ReferenceRow& row : all)
        if (row.text("case") == results.text("case")) rows.push_back(row);
      return rows;
    };
    cases.push_back({results, ofThisCase(samples), ofThisCase(errors)});
  }
  return cases;
}

}  // namespace talus::terramech::test
