#include <cmath>

#include <error_minimisation.hpp>
#include <linear_offset_stresses.hpp>

#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/strength/shear_modulus.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

#include "estimator_cases.hpp"
#include "reference_table.hpp"

namespace talus::terramech {
namespace reference_test {

std::optional<double> numberOrNone(const test::ReferenceRow& row, const std::string& column) {
  return row.has(column) ? std::optional{row[column]} : std::nullopt;
}

TEST(CategoryReference, MatchesTheReferenceOnEveryThreshold) {
  const auto rows = test::referenceTable("category_edges");
  EXPECT_EQ(rows.size(), 34u);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto& row = rows[k];
    const CategoryThresholds limits{.dp_low = row["dp_low"],
                                    .dp_high = row["dp_high"],
                                    .z_threshold = row["z_threshold"],
                                    .z_critical = row["z_critical"],
                                    .t_threshold = numberOrNone(row, "t_threshold"),
                                    .t_critical = numberOrNone(row, "t_critical")};
    const Category got = categorise({.drawbar_pull_over_load = row["drawbar_pull_over_load"],
                                     .sinkage_over_radius = row["sinkage_over_radius"],
                                     .torque_over_load_radius = numberOrNone(row, "torque_over_load_radius")},
                                    limits);
    EXPECT_EQ(name(got), row.text("category")) << "row " << k;  // Closed form: an independent implementation.
  }
}

// Closed form: every intermediate and result of the linear estimators by an independent implementation.
// Tolerance: 1e-10 for coefficients in closed form, 1e-7 for least squares because of the condition number.

using test::estimatorCases;
using test::sampleOf;
using test::samplesOf;

void expectClose(double got, double expected, double relative) {
  EXPECT_NEAR(got, expected, relative * (1.0 + std::abs(expected)));
}

TEST(EstimatorReference, IagnemmaMatchesTheReference) {
  for (const auto& c : estimatorCases()) {
    MohrCoulombLine line;
    for (const auto& row : c.rows) {
      const StressPair pair = iagnemmaPair(c.wheel(), sampleOf(row), c.shearModulus_m());
      const PeakStresses peak = trianglePeaks(c.wheel(), sampleOf(row));
      expectClose(pair.normal_Pa, row["iagnemma_normal_Pa"], 1e-10);
      expectClose(pair.shear_Pa, row["iagnemma_shear_Pa"], 1e-10);
      expectClose(peak.normal_Pa, row["peak_normal_Pa"], 1e-10);
      expectClose(peak.shear_Pa, row["peak_shear_Pa"], 1e-10);
      line.add(pair);
    }
    expectClose(line.estimate().cohesion_Pa, c.results["iagnemma_cohesion_Pa"], 1e-7);
    expectClose(line.estimate().tan_friction, c.results["iagnemma_tan_friction"], 1e-7);
  }
}

TEST(EstimatorReference, LinearOffsetMatchesTheReference) {
  for (const auto& c : estimatorCases()) {
    MohrCoulombLine simplified;
    for (const auto& row : c.rows) {
      const LinearOffsetCoefficients m = linearOffset(c.wheel(), sampleOf(row), c.shearModulus_m());
      expectClose(m.m1, row["m1"], 1e-10);
      expectClose(m.m3_Pa, row["m3_Pa"], 1e-10);
      expectClose(m.m4_Pa, row["m4_Pa"], 1e-10);
      simplified.add(m.pair());
    }
    expectClose(simplified.estimate().cohesion_Pa, c.results["offset_cohesion_Pa"], 1e-7);
    expectClose(simplified.estimate().tan_friction, c.results["offset_tan_friction"], 1e-7);
  }
}

TEST(EstimatorReference, LinearOffsetStressesMatchTheReference) {
  for (const auto& c : estimatorCases()) {
    for (const auto& row : c.rows) {
      const LinearOffsetStresses s =
          linearOffsetStresses(c.wheel(), sampleOf(row), c.results["offset_cohesion_Pa"], c.shearModulus_m());
      expectClose(s.sigma_m_Pa, row["sigma_m_Pa"], 1e-9);
      expectClose(s.tau_m_Pa, row["tau_m_Pa"], 1e-9);
      expectClose(s.tau_offset_Pa, row["tau_offset_Pa"], 1e-9);
    }
  }
}

TEST(EstimatorReference, SojournerMatchesTheReference) {
  for (const auto& c : estimatorCases()) {
    MohrCoulombLine line;
    for (const auto& row : c.rows) {
      const StressPair pair = sojournerPair(c.wheel(), sampleOf(row));
      expectClose(pair.normal_Pa, row["sojourner_normal_Pa"], 1e-10);
      expectClose(pair.shear_Pa, row["sojourner_shear_Pa"], 1e-10);
      line.add(pair);
    }
    expectClose(line.estimate().cohesion_Pa, c.results["sojourner_cohesion_Pa"], 1e-7);
    expectClose(line.estimate().tan_friction, c.results["sojourner_tan_friction"], 1e-7);
  }
}

TEST(EstimatorReference, ErrorMinimisationModulusMatchesTheReference) {
  for (const auto& c : estimatorCases()) {
    for (const auto& row : c.modulus_errors)
      expectClose(modulusError_Pa(c.wheel(), samplesOf(c), row["shear_modulus_m"]), row["error_Pa"], 1e-7);
    const ModulusEstimate best = modulusByErrorMinimisation(c.wheel(), samplesOf(c));
    // The reference search has an accuracy of about 1e-5; the criterion is flat near its minimum.
    EXPECT_NEAR(best.shear_modulus_m, c.results["error_modulus_m"], 1e-5 * c.results["error_modulus_m"]);
    expectClose(best.error, c.results["error_minimum_Pa"], 1e-5);
  }
}

TEST(EstimatorReference, ReferenceHasEightSoilsOfTenReadings) {
  const auto cases = estimatorCases();
  EXPECT_EQ(cases.size(), 8u);
  for (const auto& c : cases) EXPECT_EQ(c.rows.size() + c.modulus_errors.size(), 19u);
}

}  // namespace reference_test
}  // namespace talus::terramech
