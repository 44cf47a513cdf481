#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/tables/method_estimates.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/io/wheel_rows.hpp>
#include <talus/terramech/strength/bevameter.hpp>
#include <talus/terramech/strength/shear_modulus.hpp>
#include <talus/terramech/strength/strength_lines.hpp>
#include <talus/terramech/terramech_io.hpp>

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

PairOf pairOf(const std::string& method) {
  if (method == "sojourner")
    return [](const Wheel& wheel, const WheelSample& sample, double) { return sojournerPair(wheel, sample); };
  return method == "iagnemma" ? iagnemmaPair : linearOffsetPair;
}

ModulusCriterion criterionOf(const std::string& how) {
  return how == "error-minimisation"         ? ModulusCriterion::ErrorMinimisation
         : how == "effective-torque"         ? ModulusCriterion::TorqueRatio
         : how == "effective-torque-printed" ? ModulusCriterion::EffectiveTorque
                                             : ModulusCriterion::Joint;
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
    const ShearStrength fit = known_ ? line_.estimate() : ladder_.strength();
    return priors_.empty() ? fit : withPrior(fit, priors_);
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

void fitLine(const EstimateOptions& options, const WheelRows& rows, const std::vector<SoilPrior>& priors,
             const ProgressMonitor& watch, SoilEstimate& estimate) {
  Recursion recursion(options, rows.wheel, priors);
  std::vector<std::size_t> used;
  for (std::size_t k = 0; k < rows.samples.size(); ++k) {
    if (watch.stopped()) return;
    watch.report(static_cast<double>(k) / static_cast<double>(rows.samples.size()));
    if (!recursion.add(rows.wheels[k], rows.samples[k])) {
      estimate.rejected.push_back({.line = rows.lines[k], .reason = "torque_Nm must be > 0 to find K"});
      --estimate.rows_used;
      continue;
    }
    used.push_back(k);
    if (!options.recursive) continue;
    estimate.running.push_back(runningOf(recursion));
    estimate.running.back().line = rows.lines[k];
  }
  watch.report(1.0);
  const ModulusEstimate modulus = recursion.modulus();
  warnModulusUndetermined(modulus, estimate);
  estimate.take(recursion.strength());
  estimate.shear_modulus_m = modulus.shear_modulus_m;
  for (const std::size_t k : used)
    estimate.points.push_back(
        pairOf(options.method)(rows.wheels[k], rows.samples[k], modulus.shear_modulus_m));
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
  fitLine(options, rows, priors, watch, estimate);
  return estimate;
}

namespace {

SoilMixture priorOf(const EstimateOptions& options, double width_m) {
  SoilMixture prior =
      options.prior.empty() ? thesisSoilsOrOther() : mixtureOf(soilPriors(options.prior), width_m);
  if (const auto stated = statedModulus(options)) {
    for (SoilClass& soil : prior) soil.parameters[kShear] = Marginal::fixed(*stated);
  }
  return prior;
}

void take(const SoilPosterior& p, SoilEstimate& estimate) {
  estimate.cohesion_Pa = p.mean.cohesion_Pa;
  estimate.friction_angle_rad = p.mean.friction_angle_rad;
  estimate.tan_friction = p.tan_friction;
  estimate.shear_modulus_m = p.mean.shear_modulus_m;
  estimate.covariance = p.strength_covariance;
  estimate.sinkage_exponent = p.mean.sinkage_exponent;
  estimate.frictional_modulus = p.mean.sinkage_modulus;
  estimate.unseen = p.unseen;
}

// Processes rows one by one in constant memory.
SoilPosterior filtered(const WheelRows& rows, const SoilMixture& prior, const SoilFitOptions& fit,
                       std::vector<RunningSoil>& running, const ProgressMonitor& watch) {
  SoilFilter filter(rows.wheel, prior, {.fit = fit});
  SoilPosterior last;
  for (std::size_t k = 0; k < rows.samples.size(); ++k) {
    if (watch.stopped()) break;
    watch.report(static_cast<double>(k) / static_cast<double>(rows.samples.size()));
    filter.add({rows.wheels[k], rows.samples[k]});
    last = filter.posterior();
    running.push_back({.line = rows.lines[k],
                       .cohesion_Pa = last.mean.cohesion_Pa,
                       .friction_angle_rad = last.mean.friction_angle_rad,
                       .shear_modulus_m = last.mean.shear_modulus_m,
                       .covariance = last.strength_covariance});
  }
  watch.report(1.0);
  return last;
}

// Mean square of the whitened residuals above which the estimate has a warning.
constexpr double kMisfit = 3.0;

// Error over load or radius that is acceptable for a rigid-wheel model.
constexpr double kCoarse = 0.1;

// Adds warnings about assumptions of the posterior that the rows contradict.
void warnUncertain(const WheelRows& rows, const SoilPosterior& posterior,
                   std::vector<std::string>& warnings) {
  if (posterior.misfit > kMisfit) {
    warnings.push_back(fmt::format(
        "no soil of the prior explains the readings (misfit {:.1f}, 1 expected); trace these rows, "
        "widen --prior, or increase --noise",
        posterior.misfit));
  }
  const auto [narrow, wide] = std::ranges::minmax_element(rows.wheels, {}, &Wheel::width_m);
  if (narrow->width_m < wide->width_m) {
    warnings.push_back(
        fmt::format("k = k_c/b + k_phi is assumed constant for wheels {:g} to {:g} m wide; if k_c matters, "
                    "split the file by width",
                    narrow->width_m, wide->width_m));
  }
}

}  // namespace

SoilEstimate posteriorEstimate(const EstimateOptions& options, const ProgressMonitor& watch) {
  const WheelRows rows =
      readWheelRows(options.table, {.rover = options.rover, .needs_slip = true, .deepest = 1.0}, watch);
  const SoilMixture prior = priorOf(options, rows.wheel.width_m);
  SoilEstimate estimate;
  estimate.rejected = rows.rejected;
  estimate.ignored = rows.ignored;
  estimate.rows_used = rows.samples.size();
  SoilFitOptions fit;
  fit.noise = ReadingErrors::relative(options.noise);
  fit.draws = options.recursive ? 128 : 512;
  fit.watch = watch;
  estimate.posterior = options.recursive ? filtered(rows, prior, fit, estimate.running, watch)
                                         : fitSoil(rows.readings(), prior, fit);
  if (watch.stopped()) return estimate;
  take(*estimate.posterior, estimate);
  if (const std::string why = estimate.implausible(); !why.empty())
    throw std::domain_error(fmt::format("{}: {}; trace these rows", options.table.path, why));
  warnUncertain(rows, *estimate.posterior, estimate.warnings);
  for (const SoilClass& soil : prior) estimate.class_names.push_back(soil.name);
  return estimate;
}

namespace {

RefinedModel modelOf(const EstimateOptions& options) {
  const RefinedModel model = baseModel(options.model, options.rover).model;
  if (model.base != BaseModel::WongReece)
    throw InputError({.where = options.model,
                      .reason = "its base is linear-formula, which has no soil",
                      .remedy = "use a model with the base wong-reece"});
  return model;
}

void refuseWhatDoesNotGo(const EstimateOptions& options) {
  const auto refuse = [](const char* where, const char* reason, const char* remedy) {
    throw InputError({.where = where, .reason = reason, .remedy = remedy});
  };
  if (options.method != "wong-reece")
    refuse("--model", "its effects act on the contact stresses, which this method does not solve",
           "use --method wong-reece, or remove the option");
  if (options.recursive)
    refuse("--recursive", "cannot be combined with --model or with side forces, which are fitted all at once",
           "remove one of the two");
}

ModelSoilOptions howOf(const EstimateOptions& options) {
  ModelSoilOptions how{.noise = options.noise};
  how.shear_modulus_m = options.shear_modulus.empty() ? std::nullopt : statedModulus(options);
  if (options.prior.empty()) return how;
  how.prior = loadModel(options.prior).model;
  if (how.prior->soil_prior_std.empty())
    throw InputError({.where = "--prior " + options.prior,
                      .reason = "gives no standard deviation, so no parameter is free",
                      .remedy = "write {mean: ..., std: ...} for each unknown parameter"});
  return how;
}

SoilEstimate soilOf(const ModelSoil& found) {
  SoilEstimate estimate;
  estimate.cohesion_Pa = found.soil.cohesion_Pa;
  estimate.friction_angle_rad = found.soil.friction_angle_rad;
  estimate.tan_friction = std::tan(found.soil.friction_angle_rad);
  estimate.shear_modulus_m = found.soil.shear_modulus_m;
  estimate.covariance = found.strength_covariance;
  estimate.sinkage_exponent = found.soil.sinkage_exponent;
  estimate.cohesive_modulus = found.soil.cohesive_modulus;
  estimate.frictional_modulus = found.soil.frictional_modulus;
  estimate.unseen = found.unseen;
  return estimate;
}

// Names the column without which a soil explains the rows best, if any does.
std::string remedyFor(const RefinedModel& model, const Trial& trial, const ModelSoilOptions& how) {
  std::string remedy = "trace these rows, or increase --noise";
  double least = kMisfit;
  for (int k = 0; k < kChannels; ++k) {
    const auto channel = static_cast<Channel>(k);
    Trial without = trial;
    without.measured.col(k).setConstant(RunningSoil::kNan);
    if (!trial.has(channel) || !without.measured.array().isFinite().any()) continue;
    const ModelSoil rest = soilUnder(model, without, how);
    if (!(rest.misfit < least) || !soilOf(rest).implausible().empty()) continue;
    least = rest.misfit;
    const bool by_slope = channel == Channel::DrawbarPull && !trial.moment.empty();
    remedy = fmt::format("check unit, sign and sensor of column {}, without which the misfit is {:.1f}",
                         by_slope ? "slope_rad" : kAnswers[static_cast<std::size_t>(k)], least);
  }
  return remedy;
}

// Throws if the soil is implausible, or if it leaves more than half of a channel's readings and a tenth of load
// or radius unexplained (root mean squares; ours). Fits to measured sand do not exceed these limits.
void refuseUnexplained(const EstimateOptions& options, const RefinedModel& model, const Trial& trial,
                       const ModelSoil& found) {
  RefinedModel fitted = model;
  fitted.soil = found.soil;
  const ChannelErrors left = rmseOf(fitted, trial),
                      readings = rmseOf(Eigen::MatrixXd::Zero(trial.rows(), kChannels), trial);
  std::string why = soilOf(found).implausible();
  for (std::size_t c = 0; found.misfit > kMisfit && c < kChannels; ++c)
    if (left[c] > std::max(kCoarse, 0.5 * readings[c]))
      why = fmt::format("the nearest leaves {:.0f} % of {}", 100.0 * left[c] / readings[c], kAnswers[c]);
  if (!why.empty())
    throw std::domain_error(fmt::format("{}: no soil explains the rows (misfit {:.1f}, 1 expected): {}; {}",
                                        options.table.path, found.misfit, why,
                                        remedyFor(model, trial, howOf(options))));
}

}  // namespace

bool measuresSideForce(const TableFile& table) {
  const Telemetry rows = readTelemetry(table);
  const auto* angle = rows.find("slip_angle_rad");
  const auto* force = rows.find("side_force_N");
  const auto* load = rows.find("load_N");
  if (angle == nullptr || force == nullptr || load == nullptr) return false;
  double squares = 0.0, count = 0.0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (!std::isfinite((*angle)[k]) || !std::isfinite((*force)[k])) continue;
    if (std::abs((*angle)[k]) > kStraightUpTo_rad) return true;
    squares += std::pow((*force)[k] / (*load)[k], 2);
    ++count;
  }
  return squares > kCoarse * kCoarse * count;
}

SoilEstimate modelEstimate(const EstimateOptions& options, const ProgressMonitor& watch) {
  refuseWhatDoesNotGo(options);
  const RefinedModel given = modelOf(options);
  TelemetryOptions reading{.required = {"load_N", "slip"}};
  if (given.wheel) reading.wheel_radius_m = given.wheel->radius_m;
  const auto [model, trial, beyond_axle, rejected] =
      modelRows(readTelemetry(options.table, reading, watch), given);
  if (trial.rows() == 0)
    throw InputError(
        {.where = options.table.path, .reason = "in every row the sinkage reaches the axle", .remedy = ""});
  const ModelSoil found = soilUnder(model, trial, howOf(options));
  SoilEstimate estimate = soilOf(found);
  estimate.rejected = rejected;
  std::ranges::stable_sort(estimate.rejected, {}, &RejectedRow::line);
  estimate.rows_used = static_cast<std::size_t>(trial.rows());
  for (const Effect& effect : model.effects) estimate.effects.push_back(effect.name);
  refuseUnexplained(options, model, trial, found);
  if (found.misfit > kMisfit)
    estimate.warnings.push_back(fmt::format(
        "no soil explains the readings (misfit {:.1f}, 1 expected); trace these rows, or increase --noise",
        found.misfit));
  if (beyond_axle.rows() > 0)
    estimate.warnings.push_back(
        fmt::format("{} rows with sinkage at or above the axle were excluded", beyond_axle.rows()));
  return estimate;
}

namespace {

constexpr double kUndeterminedShare = 0.9;  // greatest posterior over prior std of a determined parameter

int indexOf(const std::string& name) {
  const auto& all = soilParameters();
  return static_cast<int>(std::ranges::find_if(all, [&](const SoilParameter& p) { return p.name == name; }) -
                          all.begin());
}

SensorNoise noiseOf(const RefinedModel& model, double relative) {
  SensorNoise noise = model.noise;
  for (std::size_t c = 0; c < kChannels; ++c)
    if (noise.absolute[c] == 0.0 && noise.relative[c] == 0.0) noise.relative[c] = relative;
  if (noise.slip_absolute == 0.0 && noise.slip_relative == 0.0) noise.slip_relative = relative;
  if (noise.load_relative == 0.0) noise.load_relative = relative;
  return noise;
}

/// Plan of a fit with only the soil parameters free.
FitPlan planOf(const RefinedModel& model, const ModelSoilOptions& options) {
  FitPlan plan = options.prior ? fitPlan(*options.prior, false) : fitPlan(model, true);
  const int shear = options.shear_modulus_m ? indexOf("shear_modulus_m") : -1;
  std::erase_if(plan.free, [&](const FittedParameter& p) { return p.effect >= 0 || p.index == shear; });
  plan.iterations = 40;
  return plan;
}

/// Covariance of cohesion c and tan phi (phi: friction angle) from that of the fitted parameters; zero for
/// parameters that are not fitted.
Eigen::Matrix2d strengthCovariance(const FitPlan& plan, const Eigen::MatrixXd& covariance, const Soil& soil) {
  const double by_phi = 1.0 + std::pow(std::tan(soil.friction_angle_rad), 2);
  const std::array<int, 2> index{indexOf("cohesion_Pa"), indexOf("friction_angle_rad")};
  const std::array<double, 2> slope{1.0, by_phi};
  Eigen::Matrix2d strength = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < plan.free.size(); ++i)
    for (std::size_t j = 0; j < plan.free.size(); ++j)
      for (std::size_t a = 0; a < 2; ++a)
        for (std::size_t b = 0; b < 2; ++b)
          if (plan.free[i].index == index[a] && plan.free[j].index == index[b])
            strength(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) =
                slope[a] * slope[b] * covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return strength;
}

}  // namespace

ModelSoil soilUnder(const RefinedModel& model, const Trial& trial, const ModelSoilOptions& options) {
  const FitPlan plan = planOf(model, options);
  RefinedModel start = model;
  start.noise = noiseOf(model, options.noise);
  // Slip and load of each row are fitted from their readings alone.
  Trial rows = trial;
  for (Eigen::Index row = 0; row < rows.rows(); ++row)
    rows.slip_variance[row] = std::pow(start.noise.slipStd(trial.slip[static_cast<std::size_t>(row)]), 2);
  rows.load_variance.setConstant(std::pow(start.noise.load_relative, 2));
  SolvedContacts solved;
  const auto whiteningBy = [&](const RefinedModel& at) {
    const Eigen::MatrixXd level = predictRows(at, rows, solved);
    return whitening(rows, level, inputSlopes(at, rows, solved), at.noise);
  };
  const auto fittedFrom = [&](const Soil& soil) {
    Fit fit{.model = start};
    fit.model.soil = soil;
    if (options.shear_modulus_m) fit.model.soil.shear_modulus_m = *options.shear_modulus_m;
    for (int round = 0; round < 3; ++round) {
      const Whitening white = whiteningBy(fit.model);
      fit = fitModel(fit.model, rows, white, plan, solved);
    }
    return fit;
  };
  Fit best = fittedFrom(options.prior ? options.prior->soil : unknownSoil().model.soil);
  // With a prior, the soil of the model is not a start value, because the prior may fix parameters.
  if (!options.prior)
    if (const Fit own = fittedFrom(model.soil); own.cost() < best.cost()) best = own;
  const Eigen::MatrixXd covariance =
      parameterCovariance(best.model, rows, whiteningBy(best.model), plan, solved);
  const auto readings = static_cast<double>(trial.measured.array().isFinite().count());
  ModelSoil found{.soil = best.model.soil,
                  .strength_covariance = strengthCovariance(plan, covariance, best.model.soil),
                  .misfit = best.chi2 / std::max(1.0, readings - static_cast<double>(plan.free.size()))};
  best.model.fitted = plan.free;
  for (const std::string& name : soilAtBounds(best.model))
    found.unseen.push_back(name + ": ended at the limit of its range");
  for (std::size_t k = 0; k < plan.free.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    const double prior = plan.soil_prior.at(plan.free[k].index).std;
    if (std::sqrt(std::max(0.0, covariance(at, at))) > kUndeterminedShare * prior)
      found.unseen.push_back(
          std::string(soilParameters()[static_cast<std::size_t>(plan.free[k].index)].name) +
          ": the posterior is almost as wide as the prior");
  }
  return found;
}

}  // namespace talus::terramech
