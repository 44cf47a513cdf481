#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/table/model_rows.hpp>
#include <talus/terramech/calibration/tables/model_estimate.hpp>
#include <talus/terramech/calibration/tables/no_soil.hpp>
#include <talus/terramech/calibration/tables/soil_groups.hpp>
#include <talus/terramech/calibration/verdict/model_soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/io/soil_priors.hpp>
#include <talus/terramech/io/terramech_io.hpp>
#include <talus/terramech/io/wheel_rows.hpp>

namespace talus::terramech {
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

// Sinkage and torque of the rows, measured and predicted for the posterior mean.
SoilAnswer answerOf(const WheelRows& rows, const SoilPosterior& posterior) {
  RefinedModel model;
  const ContactSoil& m = posterior.mean;
  model.soil = {.cohesion_Pa = m.cohesion_Pa,
                .friction_angle_rad = m.friction_angle_rad,
                .sinkage_exponent = m.sinkage_exponent,
                .cohesive_modulus = 0.0,
                .frictional_modulus = m.sinkage_modulus,
                .shear_modulus_m = m.shear_modulus_m,
                .c1 = m.c1,
                .c2 = m.c2};
  const auto count = static_cast<Eigen::Index>(rows.samples.size());
  SoilAnswer answer{.measured = Eigen::MatrixXd::Constant(count, kChannels, RunningSoil::kNan),
                    .predicted = Eigen::MatrixXd::Constant(count, kChannels, RunningSoil::kNan),
                    .misfit = posterior.misfit};
  for (Eigen::Index row = 0; row < count; ++row) {
    const WheelSample& s = rows.samples[static_cast<std::size_t>(row)];
    const Wheel& wheel = rows.wheels[static_cast<std::size_t>(row)];
    const Reading read{
        .load_N = s.load_N, .radius_m = wheel.radius_m, .sinkage_m = s.sinkage_m, .torque_Nm = s.torque_Nm};
    const Reading predicted_reading = predict(model, {.wheel = wheel, .load_N = s.load_N, .slip = s.slip});
    for (const Channel channel : {Channel::Sinkage, Channel::Torque}) {
      answer.measured(row, static_cast<int>(channel)) = read.scaled(channel);
      answer.predicted(row, static_cast<int>(channel)) = predicted_reading.scaled(channel);
    }
  }
  return answer;
}

// Adds warnings about assumptions of the posterior that the rows contradict.
void warnUncertain(const WheelRows& rows, const SoilPosterior& posterior, const std::string& groups,
                   std::vector<std::string>& warnings) {
  if (posterior.misfit > kMisfit) {
    warnings.push_back(
        fmt::format("no soil of the prior explains the readings (misfit {:.1f}, 1 expected); widen --prior "
                    "or increase --noise",
                    posterior.misfit));
  }
  if (!groups.empty()) warnings.push_back(groups);
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
  // If groupsThatDisagree() names a column, the table contains several soils, each of which may be valid.
  const std::string groups = groupsThatDisagree(rows, *estimate.posterior, fit.noise);
  if (const std::string why = noSoilExplains(estimate, answerOf(rows, *estimate.posterior));
      groups.empty() && !why.empty())
    throw std::domain_error(
        fmt::format("{}: {}; check unit, sign and sensor of torque_Nm and sinkage_m, or widen --prior",
                    options.table.path, why));
  warnUncertain(rows, *estimate.posterior, groups, estimate.warnings);
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

SoilAnswer answerOf(const RefinedModel& model, const Trial& trial, const ModelSoil& found) {
  RefinedModel fitted = model;
  fitted.soil = found.soil;
  SolvedContacts solved;
  return {
      .measured = trial.measured, .predicted = predictRows(fitted, trial, solved), .misfit = found.misfit};
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

// Channel without which a soil fits best, if any.
struct OddColumn {
  std::string column;         // empty: no column
  double misfit = kMisfit;    // misfit of the other channels
  bool contradicted = false;  // the soil from at least two other channels does not explain this channel
};

OddColumn oddColumn(const RefinedModel& model, const Trial& trial, const ModelSoilOptions& how) {
  OddColumn odd;
  int channels = 0;
  for (int k = 0; k < kChannels; ++k) channels += trial.has(static_cast<Channel>(k)) ? 1 : 0;
  for (int k = 0; k < kChannels; ++k) {
    const auto channel = static_cast<Channel>(k);
    if (!trial.has(channel) || channels < 2) continue;
    Trial without = trial;
    without.measured.col(k).setConstant(std::numeric_limits<double>::quiet_NaN());
    const ModelSoil rest = soilUnder(model, without, how);
    if (!(rest.misfit < odd.misfit) || !soilOf(rest).implausible().empty()) continue;
    const bool by_slope = channel == Channel::DrawbarPull && !trial.moment.empty();
    odd = {.column = by_slope ? "slope_rad" : columnOf(channel),
           .misfit = rest.misfit,
           .contradicted = channels > 2 && leavesUnexplained(answerOf(model, trial, rest), channel)};
  }
  return odd;
}

std::string remedyFor(const OddColumn& odd) {
  if (odd.column.empty()) return "no single column is at fault; trace these rows, or increase --noise";
  return fmt::format("check unit, sign and sensor of column {}, without which the misfit is {:.1f}",
                     odd.column, odd.misfit);
}

// Throws if no soil explains the rows, and warns if the fit is poor. A large misfit may be a model error if
// no single column causes the misfit, or if the other columns predict that column approximately.
void judgeFit(const EstimateOptions& options, const RefinedModel& model, const Trial& trial,
              const ModelSoil& found, SoilEstimate& estimate) {
  const bool poor = found.misfit > kMisfit;
  if (!poor && estimate.implausible().empty()) return;
  const std::string effects = options.model.empty() ? "" : "with the effects of " + options.model + " ";
  const OddColumn odd = oddColumn(model, trial, howOf(options));
  std::string why = noSoilExplains(estimate, answerOf(model, trial, found));
  if (why.empty() && odd.contradicted)
    why =
        fmt::format("no soil explains the rows (misfit {:.1f}, 1 expected): {} contradicts the other columns",
                    found.misfit, odd.column);
  if (!why.empty())
    throw std::domain_error(fmt::format("{}: {}{}; {}", options.table.path, effects, why, remedyFor(odd)));
  estimate.warnings.push_back(fmt::format(
      "{}no soil explains the readings (misfit {:.1f}, 1 expected); trace these rows, or increase --noise",
      effects, found.misfit));
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
  judgeFit(options, model, trial, found, estimate);
  if (beyond_axle.rows() > 0)
    estimate.warnings.push_back(
        fmt::format("{} rows with sinkage at or above the axle were excluded", beyond_axle.rows()));
  return estimate;
}

}  // namespace talus::terramech
