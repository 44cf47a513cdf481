#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include <talus/terramech/calibration/tables/no_soil.hpp>
#include <talus/terramech/calibration/tables/posterior_estimate.hpp>
#include <talus/terramech/calibration/tables/soil_groups.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/estimate/soil_filter.hpp>
#include <talus/terramech/io/soil_priors.hpp>
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

}  // namespace talus::terramech
