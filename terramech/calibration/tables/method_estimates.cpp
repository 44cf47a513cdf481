#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include <talus/terramech/calibration.hpp>
#include <talus/terramech/calibration/fit/model_fit.hpp>
#include <talus/terramech/calibration/search/trace_search.hpp>
#include <talus/terramech/calibration/search/trial_fit.hpp>
#include <talus/terramech/calibration/tables/method_estimates.hpp>
#include <talus/terramech/io/model_file.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/io/wheel_rows.hpp>
#include <talus/terramech/numerics/functions.hpp>
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

// Mean square of the residuals over their errors above which the estimate has a warning.
constexpr double kMisfit = 3.0;

// Error over load or radius that is acceptable for a rigid-wheel model.
constexpr double kCoarse = 0.1;

// Greatest number of rows of a fit, as in traceResiduals().
constexpr int kMostRows = 1000;

void refuseWhatDoesNotGo(const EstimateOptions& options) {
  const auto refuse = [](const char* where, const char* reason, const char* remedy) {
    throw InputError({.where = where, .reason = reason, .remedy = remedy});
  };
  if (options.method != "wong-reece")
    refuse("--model", "its effects act on the contact stresses, which this method does not solve",
           "use --method wong-reece, or remove the option");
  if (options.recursive)
    refuse("--recursive", "cannot be combined with --method wong-reece, which fits all rows at once",
           "remove the option, or use --method linear-offset");
}

ModelSoilOptions howOf(const EstimateOptions& options) {
  ModelSoilOptions how{.prior = soilPriors(options.prior), .noise = options.noise};
  how.shear_modulus_m = options.shear_modulus.empty() ? std::nullopt : statedModulus(options);
  for (const SoilPrior& soil : how.prior) {
    RefinedModel model;
    setSoil(model, soil);
    if (model.soil_prior_std.empty())
      throw InputError({.where = "--prior " + options.prior,
                        .reason = "gives no standard deviation, so no parameter is free",
                        .remedy = "write {mean: ..., std: ...} for each unknown parameter"});
  }
  return how;
}

SoilEstimate soilOf(const ModelSoil& found) {
  const Soil& soil = found.model.soil;
  SoilEstimate estimate;
  estimate.cohesion_Pa = soil.cohesion_Pa;
  estimate.friction_angle_rad = soil.friction_angle_rad;
  estimate.tan_friction = std::tan(soil.friction_angle_rad);
  estimate.shear_modulus_m = soil.shear_modulus_m;
  estimate.shear_modulus_std_m = found.std("shear_modulus_m");
  estimate.covariance = found.strengthCovariance();
  estimate.sinkage_exponent = soil.sinkage_exponent;
  estimate.cohesive_modulus = soil.cohesive_modulus;
  estimate.frictional_modulus = soil.frictional_modulus;
  estimate.unseen = found.unseen;
  estimate.model = found.model;
  estimate.misfit = found.misfit;
  return estimate;
}

// Names the column without which a soil explains the rows best, if any does.
std::string remedyFor(const RefinedModel& model, const Trial& trial, const ModelSoilOptions& how) {
  std::string remedy = "trace these rows";
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
  const ChannelErrors left = rmseOf(found.model, trial),
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

// Adds warnings about assumptions that the rows contradict.
void warnUncertain(const Trial& trial, const ModelSoil& found, std::vector<std::string>& warnings) {
  if (found.misfit > kMisfit)
    warnings.push_back(fmt::format(
        "no soil explains the readings (misfit {:.1f}, 1 expected), least of all {}; trace these rows",
        found.misfit, kAnswers[static_cast<std::size_t>(found.worst)]));
  const auto [narrow, wide] =
      std::ranges::minmax_element(trial.states, {}, [](const WheelState& s) { return s.wheel.width_m; });
  if (narrow->wheel.width_m < wide->wheel.width_m)
    warnings.push_back(
        fmt::format("the ratio of k_c to k_phi is that of the prior for wheels {:g} to {:g} m wide; if k_c "
                    "matters, split the file by width",
                    narrow->wheel.width_m, wide->wheel.width_m));
}

}  // namespace

TableRows tableRows(const TableFile& table, const std::string& file, const std::string& rover,
                    const ProgressMonitor& watch) {
  const RefinedModel given = baseModel(file, rover).model;
  if (given.base != BaseModel::WongReece)
    throw InputError({.where = file,
                      .reason = "its base is linear-formula, which has no soil",
                      .remedy = "use a model with the base wong-reece"});
  TelemetryOptions reading{.required = {"load_N", "slip"}};
  if (given.wheel) reading.wheel_radius_m = given.wheel->radius_m;
  ModelRows rows = modelRows(readTelemetry(table, reading, watch), given);
  if (rows.trial.rows() == 0)
    throw InputError(
        {.where = table.path, .reason = "in every row the sinkage reaches the axle", .remedy = ""});
  TableRows all{.model = rows.model, .trial = rows.trial, .rejected = rows.rejected, .warnings = {}};
  std::ranges::stable_sort(all.rejected, {}, &RejectedRow::line);
  if (rows.beyond_axle.rows() > 0)
    all.warnings.push_back(
        fmt::format("{} rows with sinkage at or above the axle were excluded", rows.beyond_axle.rows()));
  if (rows.trial.rows() > kMostRows) {
    all.trial = subset(rows.trial, rowSample(rows.trial, kMostRows, 1));
    all.warnings.push_back(
        fmt::format("{} of {} rows were sampled for the fit", all.trial.rows(), rows.trial.rows()));
  }
  return all;
}

SoilEstimate modelEstimate(const EstimateOptions& options, const ProgressMonitor& watch) {
  refuseWhatDoesNotGo(options);
  const TableRows rows = tableRows(options.table, options.model, options.rover, watch);
  const ModelSoilOptions how = howOf(options);
  const ModelSoil found = soilUnder(rows.model, rows.trial, how, watch);
  SoilEstimate estimate = soilOf(found);
  if (watch.stopped()) return estimate;
  for (std::size_t k = 0; k < how.prior.size(); ++k)
    estimate.classes.emplace_back(how.prior[k].mean.name, found.probability[k]);
  estimate.rejected = rows.rejected;
  estimate.warnings = rows.warnings;
  estimate.rows_used = static_cast<std::size_t>(rows.trial.rows());
  for (const Effect& effect : rows.model.effects) estimate.effects.push_back(effect.name);
  refuseUnexplained(options, rows.model, rows.trial, found);
  warnUncertain(rows.trial, found, estimate.warnings);
  return estimate;
}

namespace {

constexpr double kUndeterminedShare = 0.9;  // greatest posterior over prior std of a determined parameter
constexpr double kTypicalError = 0.05;      // relative error of a reading whose error is not stated

using SoilValues = Eigen::VectorXd;  // parameters in the order of soilParameters()

int indexOf(std::string_view name) {
  const auto& all = soilParameters();
  return static_cast<int>(std::ranges::find_if(all, [&](const SoilParameter& p) { return p.name == name; }) -
                          all.begin());
}

// One soil of the prior, its fit, or the mixture of several.
struct SoilNormal {
  double weight = 1.0;
  Soil soil;
  SoilValues mean = SoilValues::Zero(static_cast<Eigen::Index>(soilParameters().size()));
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(mean.size(), mean.size());
};

// The stiffness of `mean` is the logarithm of k under a wheel of width_m.
SoilNormal normalOf(const Soil& soil, double width_m) {
  SoilNormal normal{.soil = soil};
  for (std::size_t k = 0; k < soilParameters().size(); ++k)
    normal.mean[static_cast<Eigen::Index>(k)] =
        soilParameters()[k].field ? soilParameters()[k].get(soil) : std::log(sinkageModulus(soil, width_m));
  return normal;
}

SoilNormal priorOf(const RefinedModel& model, double width_m) {
  SoilNormal normal = normalOf(model.soil, width_m);
  for (const auto& [name, std] : model.soil_prior_std) {
    const int k = indexOf(name);
    normal.covariance(k, k) = std * std;
  }
  return normal;
}

// Mean and covariance of a mixture; weights have sum 1.
SoilNormal mixtureOf(const std::vector<SoilNormal>& parts, double width_m) {
  SoilNormal all{.soil = std::ranges::max_element(parts, {}, &SoilNormal::weight)->soil};
  for (const SoilNormal& part : parts) all.mean += part.weight * part.mean;
  for (const SoilNormal& part : parts) {
    const SoilValues away = part.mean - all.mean;
    all.covariance += part.weight * (part.covariance + away * away.transpose());
  }
  for (std::size_t k = 0; k < soilParameters().size(); ++k) {
    const SoilParameter& p = soilParameters()[k];
    const double mean = all.mean[static_cast<Eigen::Index>(k)];
    p.set(all.soil, p.field ? mean : mean - std::log(sinkageModulus(all.soil, width_m)));
  }
  return all;
}

// Fits the soil of `start` under its prior with the errors of `fit`; the weight is the logarithm of the evidence.
SoilNormal fitted(const TrialFit& fit, const RefinedModel& start, double width_m) {
  const CalibratedRows& rows = fit.rows();
  FitPlan plan = fitPlan(start, false);
  std::erase_if(plan.free, [](const FittedParameter& p) { return p.effect >= 0; });
  plan.iterations = 40;
  plan.misfit = misfitOf(rows.white(), rows.trial());
  SolvedContacts solved = fit.solved();
  const Fit best = fitModel(start, rows.trial(), rows.whitening(), plan, solved);
  const Eigen::MatrixXd covariance =
      parameterCovariance(best.model, rows.trial(), rows.whitening(), plan, solved);
  SoilNormal normal = normalOf(best.model.soil, width_m);
  normal.weight = -0.5 * best.cost() / plan.misfit;
  for (std::size_t i = 0; i < plan.free.size(); ++i) {
    normal.weight -= std::log(plan.soil_prior.at(plan.free[i].index).std);
    for (std::size_t j = 0; j < plan.free.size(); ++j)
      normal.covariance(plan.free[i].index, plan.free[j].index) =
          covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  const Eigen::LDLT<Eigen::MatrixXd> root(covariance);
  normal.weight += 0.5 * root.vectorD().array().max(1e-300).log().sum();
  return normal;
}

void normaliseWeights(std::vector<SoilNormal>& parts) {
  const double most = std::ranges::max_element(parts, {}, &SoilNormal::weight)->weight;
  double sum = 0.0;
  for (SoilNormal& part : parts) sum += part.weight = std::exp(part.weight - most);
  for (SoilNormal& part : parts) part.weight /= sum;
}

// Writes the mean square of the residuals over the stated errors of the sensors.
void compareWithStated(const Trial& trial, double noise, ModelSoil& found) {
  const StatedSensors& stated = found.model.stated;
  const double relative = noise > 0.0 ? noise : kTypicalError;
  SensorNoise errors;
  const std::array given{stated.drawbar_pull_N, stated.sinkage_m, stated.torque_Nm, stated.side_force_N};
  const double load_N =
      std::reduce(trial.load_N.begin(), trial.load_N.end()) / std::max<double>(1.0, trial.rows());
  for (std::size_t c = 0; c < kChannels; ++c) {
    const bool force = c == static_cast<std::size_t>(Channel::DrawbarPull) ||
                       c == static_cast<std::size_t>(Channel::SideForce);  // may be zero
    (given[c] || force ? errors.absolute[c] : errors.relative[c]) =
        given[c].value_or(force ? relative * load_N : relative);
  }
  (stated.slip ? errors.slip_absolute : errors.slip_relative) = stated.slip.value_or(relative);
  errors.load_relative = relative;
  Trial rows = asMeasured(trial);
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    const auto r = static_cast<std::size_t>(row);
    rows.slip_variance[row] = std::pow(errors.slipStd(trial.slip[r]), 2);
    rows.load_variance[row] = std::pow(stated.load_N ? *stated.load_N / trial.load_N[r] : relative, 2);
  }
  SolvedContacts solved;
  const Eigen::MatrixXd level = predictRows(found.model, rows, solved);
  const Whitening white = whitening(rows, level, inputSlopes(found.model, rows, solved), errors);
  const Eigen::MatrixXd residual = trial.measured - level;
  const auto readings = static_cast<double>(residual.array().isFinite().count());
  found.misfit = white.apply(residual).squaredNorm() /
                 std::max(1.0, readings - static_cast<double>(found.model.fitted.size()));
  const Eigen::VectorXd alone = white.marginal(residual);
  std::array<double, kChannels> sum{};
  for (Eigen::Index k = 0; k < alone.size(); ++k)
    sum[static_cast<std::size_t>(k % kChannels)] += alone[k] * alone[k];
  found.worst = static_cast<Channel>(std::ranges::max_element(sum) - sum.begin());
}

void listUnseen(const SoilNormal& prior, const SoilNormal& posterior, ModelSoil& found) {
  for (const std::string& name : soilAtBounds(found.model))
    found.unseen.push_back(name + ": ended at the limit of its range");
  for (const FittedParameter& p : found.model.fitted) {
    const std::string name = soilParameters()[static_cast<std::size_t>(p.index)].name;
    const double before = prior.covariance(p.index, p.index), after = posterior.covariance(p.index, p.index);
    if (name != "c1" && name != "c2" && after > kUndeterminedShare * kUndeterminedShare * before)
      found.unseen.push_back(name + ": the posterior is almost as wide as the prior; vary " +
                             (name == "shear_modulus_m" ? "the slip, mainly at low slip" : "the load"));
  }
}

}  // namespace

double ModelSoil::std(const std::string& parameter) const {
  const std::size_t n = model.fitted.size();
  for (std::size_t k = 0; k < n; ++k)
    if (model.fitted[k].index == indexOf(parameter)) return std::sqrt(model.covariance[k * (n + 1)]);
  return 0.0;
}

Eigen::Matrix2d ModelSoil::strengthCovariance() const {
  const std::array index{indexOf("cohesion_Pa"), indexOf("friction_angle_rad")};
  const std::array slope{1.0, 1.0 + std::pow(std::tan(model.soil.friction_angle_rad), 2)};
  const std::size_t n = model.fitted.size();
  Eigen::Matrix2d strength = Eigen::Matrix2d::Zero();
  for (std::size_t k = 0; k < n * n; ++k)
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t b = 0; b < 2; ++b)
        if (model.fitted[k / n].index == index[a] && model.fitted[k % n].index == index[b])
          strength(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) =
              slope[a] * slope[b] * model.covariance[k];
  return strength;
}

ModelSoil soilUnder(const RefinedModel& model, const Trial& trial, const ModelSoilOptions& options,
                    const ProgressMonitor& watch) {
  RefinedModel start = asDriven(model, trial);
  if (options.noise > 0.0) start.stated.relative = options.noise;
  start.soil = unknownSoil().model.soil;
  giveVaguePrior(start);
  const double width_m = trial.states.front().wheel.width_m;
  const auto hold = [&](RefinedModel& at) {
    if (!options.shear_modulus_m) return;
    at.soil.shear_modulus_m = *options.shear_modulus_m;
    at.soil_prior_std.erase("shear_modulus_m");
  };
  hold(start);
  RoundProgress rounds;
  const auto go_on = [&](double share) {
    watch.report(rounds.at(share));
    return !watch.stopped();
  };
  const TrialFit fit{start, trial, false, go_on, false};
  std::vector<RefinedModel> starts;
  for (const SoilPrior& soil : options.prior) {
    starts.push_back(fit.model());
    setSoil(starts.back(), soil);
    hold(starts.back());
  }
  if (starts.empty()) starts.push_back(fit.model());
  std::vector<SoilNormal> priors, parts;
  for (const RefinedModel& at : starts) {
    priors.push_back(priorOf(at, width_m));
    priors.back().weight = 1.0 / static_cast<double>(starts.size());
    parts.push_back(fitted(fit, at, width_m));
  }
  normaliseWeights(parts);
  const SoilNormal posterior = mixtureOf(parts, width_m);
  ModelSoil found{.model = fit.model()};
  found.model.soil = posterior.soil;
  for (const SoilNormal& part : parts) found.probability.push_back(part.weight);
  found.model.fitted.clear();
  found.model.covariance.clear();
  for (int k = 0; k < posterior.mean.size(); ++k)
    if (posterior.covariance(k, k) > 0.0) found.model.fitted.push_back({.effect = -1, .index = k});
  for (const FittedParameter& a : found.model.fitted)
    for (const FittedParameter& b : found.model.fitted)
      found.model.covariance.push_back(posterior.covariance(a.index, b.index));
  compareWithStated(trial, options.noise, found);
  listUnseen(mixtureOf(priors, width_m), posterior, found);
  watch.report(1.0);
  return found;
}

}  // namespace talus::terramech
