#include <cmath>

#include <talus/common/input_error.hpp>
#include <talus/terramech/calibration/tables/plate_estimate.hpp>
#include <talus/terramech/io/bevameter_table.hpp>
#include <talus/terramech/io/soil_priors.hpp>
#include <talus/terramech/strength/plate_trials.hpp>

namespace talus::terramech {

SoilEstimate plateEstimate(const EstimateOptions& options, const ProgressMonitor& watch) {
  const BevameterTable table = readBevameterTable(options.table, options.plate_width_m, watch);
  const auto priors = strengthPriors(soilPriors(options.prior));
  if (!priors.empty() && table.shear.empty()) {
    throw InputError({.where = "--prior " + options.prior,
                      .reason = "the prior applies to cohesion and friction, and the table has no shear test",
                      .remedy = "remove --prior, or add shear_stress_Pa"});
  }
  SoilEstimate estimate;
  estimate.rejected = table.rejected;
  estimate.rows_used = table.shear.size();
  for (const PlateTrial& trial : table.plates) estimate.rows_used += trial.readings.size();
  if (!table.shear.empty()) {
    const ShearFit fit = fitShear(table.shear);
    estimate.take(priors.empty() ? fit.strength : withPrior(fit.strength, priors));
    estimate.shear_modulus_m = fit.shear_modulus_m;
    if (fit.modulus_at_bound)
      estimate.unseen.emplace_back("shear_modulus_m: not identifiable from the displacements");
    for (const ShearReading& r : table.shear) {
      const double share = -std::expm1(-r.displacement_m / fit.shear_modulus_m);
      estimate.points.push_back({.normal_Pa = r.normal_Pa, .shear_Pa = r.shear_Pa / share});
    }
  }
  if (!table.plates.empty()) {
    if (table.width_from_force) {
      estimate.warnings.emplace_back(
          "no plate_width_m: assuming round plates with diameters from F_N and the pressure; pass "
          "--plate-width for other plates");
    }
    estimate.soils = trialSoils(table.plates);
    if (estimate.soils.size() > 1) {
      estimate.warnings.push_back("plate tests of " + std::to_string(estimate.soils.size()) +
                                  " soils (column soil): each is fitted for itself");
      return estimate;
    }
    const PressureSinkage& fit = estimate.soils.front().fit;
    estimate.sinkage_exponent = fit.sinkage_exponent;
    estimate.plates = fit.plates;
    estimate.cohesive_modulus = fit.cohesive_modulus;
    estimate.frictional_modulus = fit.frictional_modulus;
    if (fit.cohesive_modulus && *fit.cohesive_modulus < 0.0) {
      estimate.warnings.emplace_back(
          "k_c < 0: wider plates are stiffer, which cohesion cannot explain; use k of the plate nearest in "
          "width");
    }
    if (!fit.refused.empty())
      estimate.unseen.push_back("cohesive_modulus, frictional_modulus: " + fit.refused);
  }
  return estimate;
}

}  // namespace talus::terramech
