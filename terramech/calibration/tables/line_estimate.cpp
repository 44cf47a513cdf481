#include <cmath>
#include <limits>
#include <stdexcept>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/tables/line_estimate.hpp>
#include <talus/terramech/io/soil_priors.hpp>
#include <talus/terramech/io/terramech_io.hpp>
#include <talus/terramech/io/wheel_rows.hpp>
#include <talus/terramech/strength/bevameter.hpp>
#include <talus/terramech/strength/shear_modulus.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

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

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

StressPair spinPair(const Wheel& wheel, const WheelSample& sample, double /*shear_modulus_m*/) {
  return sojournerPair(wheel, sample);
}

PairOf pairOf(const std::string& method) {
  return method == "sojourner" ? spinPair : method == "iagnemma" ? iagnemmaPair : linearOffsetPair;
}

ModulusCriterion criterionOf(const std::string& how) {
  return how == "error-minimisation"         ? ModulusCriterion::ErrorMinimisation
         : how == "effective-torque"         ? ModulusCriterion::TorqueRatio
         : how == "effective-torque-printed" ? ModulusCriterion::EffectiveTorque
                                             : ModulusCriterion::Joint;
}

ModulusEstimate findModulus(ModulusCriterion criterion, const WheelRows& rows, const ProgressMonitor& watch) {
  switch (criterion) {
    case ModulusCriterion::ErrorMinimisation:
      return modulusByErrorMinimisation(rows.wheel, rows.samples, {}, watch);
    case ModulusCriterion::TorqueRatio:
      return modulusByTorqueRatio(rows.wheel, rows.samples);
    case ModulusCriterion::EffectiveTorque:
      return modulusByEffectiveTorque(rows.wheel, rows.samples);
    case ModulusCriterion::Joint:
      break;
  }
  return modulusJointly(rows.wheel, rows.samples, {}, watch);
}

// Shear modulus column of the file, if it has one value in all rows.
std::optional<double> columnModulus(const EstimateOptions& options) {
  const Telemetry table = readTelemetry(options.table);
  const auto* column = table.find("shear_modulus_m");
  if (column == nullptr || column->empty() || !(column->front() > 0.0)) return std::nullopt;
  for (const double k : *column) {
    if (k != column->front()) return std::nullopt;
  }
  return column->front();
}

// Known K: the stated value, else that of the file, else that of the prior; nullopt if K must be estimated,
// NaN if the method needs no K.
std::optional<double> knownModulus(const EstimateOptions& options, const std::vector<SoilPrior>& priors) {
  if (options.method == "sojourner") return kNan;
  if (const auto stated = statedModulus(options)) return stated;
  if (!options.shear_modulus.empty()) return std::nullopt;
  if (const auto column = columnModulus(options)) return column;
  if (!priors.empty()) return meanModulus(priors);
  return std::nullopt;
}

void warnModulusUndetermined(const ModulusEstimate& k, SoilEstimate& estimate) {
  if (!k.at_bound) return;
  estimate.unseen.emplace_back(
      "shear_modulus_m: no minimum between 2 and 100 mm; vary the slip, or pass --shear-modulus");
}

ShearStrength withPriors(const ShearStrength& fit, const std::vector<StrengthPrior>& priors) {
  return priors.empty() ? fit : withPrior(fit, priors);
}

// Points to which the line is fitted.
std::vector<StressPair> pointsOf(const EstimateOptions& options, const WheelRows& rows, double modulus) {
  std::vector<StressPair> points;
  for (std::size_t k = 0; k < rows.samples.size(); ++k)
    points.push_back(pairOf(options.method)(rows.wheels[k], rows.samples[k], modulus));
  return points;
}

// Fits all rows at once.
void fitTogether(const EstimateOptions& options, const WheelRows& rows, const std::vector<SoilPrior>& priors,
                 const ProgressMonitor& watch, SoilEstimate& estimate) {
  const auto known = knownModulus(options, priors);
  const auto modulus = known ? ModulusEstimate{.shear_modulus_m = *known}
                             : findModulus(criterionOf(options.shear_modulus), rows, watch);
  if (watch.stopped()) return;
  warnModulusUndetermined(modulus, estimate);
  MohrCoulombLine line;
  estimate.points = pointsOf(options, rows, modulus.shear_modulus_m);
  for (const StressPair& point : estimate.points) line.add(point);
  estimate.take(withPriors(line.estimate(), strengthPriors(priors)));
  estimate.shear_modulus_m = modulus.shear_modulus_m;
}

// Fits row by row in constant memory: one line if K is known, else one line per value of the shear-modulus
// grid.
class Recursion {
 public:
  Recursion(const EstimateOptions& options, const Wheel& wheel, const std::vector<SoilPrior>& priors)
      : known_(knownModulus(options, priors)),
        priors_(strengthPriors(priors)),
        pair_(pairOf(options.method)),
        ladder_(wheel, {.criterion = criterionOf(options.shear_modulus), .pair = pair_}) {}

  // Returns false if the sample gives no equation.
  bool add(const Wheel& wheel, const WheelSample& sample) {
    if (!known_) return ladder_.add(sample);
    line_.add(pair_(wheel, sample, *known_));
    return true;
  }
  ShearStrength strength() const {
    return withPriors(known_ ? line_.estimate() : ladder_.strength(), priors_);
  }
  ModulusEstimate modulus() const {
    return known_ ? ModulusEstimate{.shear_modulus_m = *known_} : ladder_.modulus();
  }

 private:
  std::optional<double> known_;
  std::vector<StrengthPrior> priors_;
  PairOf pair_;
  MohrCoulombLine line_;
  ShearModulusGrid ladder_;
};

RunningSoil runningOf(const Recursion& recursion) {
  try {
    const ShearStrength fit = recursion.strength();
    return {.cohesion_Pa = fit.cohesion_Pa,
            .friction_angle_rad = fit.frictionAngle_rad(),
            .shear_modulus_m = recursion.modulus().shear_modulus_m,
            .covariance = fit.covariance};
  } catch (const std::domain_error&) {  // too few rows
    return {};
  }
}

void fitRecursively(const EstimateOptions& options, const WheelRows& rows,
                    const std::vector<SoilPrior>& priors, const ProgressMonitor& watch,
                    SoilEstimate& estimate) {
  Recursion recursion(options, rows.wheel, priors);
  for (std::size_t k = 0; k < rows.samples.size(); ++k) {
    if (watch.stopped()) return;
    watch.report(static_cast<double>(k) / static_cast<double>(rows.samples.size()));
    if (!recursion.add(rows.wheels[k], rows.samples[k])) {
      estimate.rejected.push_back({.line = rows.lines[k], .reason = "torque_Nm must be > 0 to find K"});
      --estimate.rows_used;
      continue;
    }
    estimate.running.push_back(runningOf(recursion));
    estimate.running.back().line = rows.lines[k];
  }
  watch.report(1.0);
  const ModulusEstimate modulus = recursion.modulus();
  warnModulusUndetermined(modulus, estimate);
  estimate.take(recursion.strength());
  estimate.shear_modulus_m = modulus.shear_modulus_m;
  estimate.points = pointsOf(options, rows, modulus.shear_modulus_m);
}

}  // namespace

SoilEstimate lineEstimate(const EstimateOptions& options, const ProgressMonitor& watch) {
  const bool spin = options.method == "sojourner";
  const WheelRows rows = readWheelRows(options.table, {.rover = options.rover, .needs_slip = !spin}, watch);
  const std::vector<SoilPrior> priors = soilPriors(options.prior);
  if (!rows.one_wheel && !knownModulus(options, priors)) {
    throw InputError(
        {.where = rows.source,
         .reason = "contains wheels of several sizes; K is found by comparing rows of one size",
         .remedy = "pass K with --shear-modulus, use --method wong-reece, or split the file by size"});
  }
  SoilEstimate estimate;
  estimate.rejected = rows.rejected;
  estimate.ignored = rows.ignored;
  estimate.rows_used = rows.samples.size();
  (options.recursive ? fitRecursively : fitTogether)(options, rows, priors, watch, estimate);
  return estimate;
}

}  // namespace talus::terramech
