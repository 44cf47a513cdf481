#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <talus/cli/soil/bevameter_table.hpp>
#include <talus/cli/soil/line_estimate.hpp>
#include <talus/cli/soil/model_estimate.hpp>
#include <talus/cli/soil/prior_option.hpp>
#include <talus/cli/soil/soil_estimate.hpp>
#include <talus/cli/soil/soil_groups.hpp>
#include <talus/terramech/estimate/soil_filter.hpp>

namespace talus::cli {
namespace {

using namespace terramech;

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

// Row by row in constant memory.
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

// What the posterior takes for granted and these rows may not bear out.
void sayWhatIsDoubtful(const WheelRows& rows, const SoilPosterior& posterior, const ReadingErrors& noise,
                       std::vector<std::string>& warnings) {
  constexpr double kMisfit = 3.0;
  if (posterior.misfit > kMisfit) {
    warnings.push_back(fmt::format(
        "no soil of the prior explains the readings (misfit {:.1f}, 1 expected); widen --prior or --noise",
        posterior.misfit));
  }
  if (const std::string text = groupsThatDisagree(rows, posterior, noise); !text.empty())
    warnings.push_back(text);
  const auto [narrow, wide] = std::ranges::minmax_element(rows.wheels, {}, &Wheel::width_m);
  if (narrow->width_m < wide->width_m) {
    warnings.push_back(
        fmt::format("k = k_c/b + k_phi is taken as one value under wheels of {:g} to {:g} m width; where k_c "
                    "matters, one file for each width",
                    narrow->width_m, wide->width_m));
  }
}

SoilEstimate posteriorEstimate(const EstimateOptions& options, const ProgressMonitor& watch) {
  const WheelRows rows = readWheelRows(options.table, {.rover = options.rover, .needs_slip = true}, watch);
  const SoilMixture prior = priorOf(options, rows.wheel.width_m);
  SoilEstimate estimate;
  estimate.rejected = rows.rejected;
  estimate.rows_used = rows.samples.size();
  SoilFitOptions fit;
  fit.noise = ReadingErrors::relative(options.noise);
  fit.draws = options.recursive ? 128 : 512;
  fit.watch = watch;
  estimate.posterior = options.recursive ? filtered(rows, prior, fit, estimate.running, watch)
                                         : fitSoil(rows.readings(), prior, fit);
  if (watch.stopped()) return estimate;
  take(*estimate.posterior, estimate);
  sayWhatIsDoubtful(rows, *estimate.posterior, fit.noise, estimate.warnings);
  for (const SoilClass& soil : prior) estimate.class_names.push_back(soil.name);
  return estimate;
}

SoilEstimate bevameterEstimate(const EstimateOptions& options, const ProgressMonitor& watch) {
  const BevameterTable table = readBevameterTable(options.table, options.plate_width_m, watch);
  const auto priors = strengthPriors(soilPriors(options.prior));
  if (!priors.empty() && table.shear.empty()) {
    throw InputError({.where = "--prior " + options.prior,
                      .reason = "cohesion and friction take a prior, and the table has no shear test",
                      .remedy = "leave it out, or add shear_stress_Pa"});
  }
  SoilEstimate estimate;
  estimate.rejected = table.rejected;
  estimate.rows_used = table.shear.size() + table.plates.size();
  if (!table.shear.empty()) {
    const ShearFit fit = fitShear(table.shear);
    estimate.take(priors.empty() ? fit.strength : withPrior(fit.strength, priors));
    estimate.shear_modulus_m = fit.shear_modulus_m;
    if (fit.modulus_at_bound)
      estimate.unseen.emplace_back("shear_modulus_m: the displacements do not show it");
    for (const ShearReading& r : table.shear) {
      const double share = -std::expm1(-r.displacement_m / fit.shear_modulus_m);
      estimate.points.push_back({.normal_Pa = r.normal_Pa, .shear_Pa = r.shear_Pa / share});
    }
  }
  if (!table.plates.empty()) {
    if (table.width_from_force) {
      estimate.warnings.emplace_back(
          "no plate_width_m: plates are taken as round, their diameters from F_N and the pressure; state "
          "--plate-width where they are not");
    }
    PressureSinkageFit fitter;
    for (const PlateReading& r : table.plates) fitter.add(r);
    const PressureSinkage fit = fitter.estimate();
    estimate.sinkage_exponent = fit.sinkage_exponent;
    estimate.plates = fit.plates;
    estimate.cohesive_modulus = fit.cohesive_modulus;
    estimate.frictional_modulus = fit.frictional_modulus;
    if (fit.cohesive_modulus && *fit.cohesive_modulus < 0.0) {
      estimate.warnings.emplace_back(
          "k_c < 0: wider plates are stiffer, which no cohesion explains; take k of the plate nearest in "
          "width");
    }
    if (!fit.refused.empty())
      estimate.unseen.push_back("cohesive_modulus, frictional_modulus: " + fit.refused);
  }
  return estimate;
}

}  // namespace

SoilEstimate::SoilEstimate()
    : cohesion_Pa(RunningSoil::kNan),
      tan_friction(RunningSoil::kNan),
      shear_modulus_m(RunningSoil::kNan),
      covariance(Eigen::Matrix2d::Constant(RunningSoil::kNan)),
      friction_angle_rad(RunningSoil::kNan),
      sinkage_exponent(RunningSoil::kNan) {}

void SoilEstimate::take(const ShearStrength& fit) {
  cohesion_Pa = fit.cohesion_Pa;
  tan_friction = fit.tan_friction;
  friction_angle_rad = fit.frictionAngle_rad();
  covariance = fit.covariance;
  unseen.insert(unseen.end(), fit.unseen.begin(), fit.unseen.end());
}

std::string SoilEstimate::implausible() const {
  constexpr double kSteepest = 1.7320508075688772;  // tan 60 deg
  const double c = cohesion_Pa + 2.0 * std::sqrt(covariance(0, 0));
  const double doubt = 2.0 * std::sqrt(covariance(1, 1));
  const bool no_cohesion = c < 0.0;
  const bool no_friction = tan_friction + doubt < 0.0 || tan_friction - doubt > kSteepest;
  if (!no_cohesion && !no_friction) return {};
  return fmt::format(
      "{} no soil has: the rows do not behave as the method assumes (one soil, no slip-sinkage, no grousers)",
      no_cohesion && no_friction ? "a cohesion and a friction angle that"
      : no_cohesion              ? "a cohesion that"
                                 : "a friction angle that");
}

double frictionStd_rad(const Eigen::Matrix2d& covariance, double friction_angle_rad) {
  return std::sqrt(covariance(1, 1)) * std::pow(std::cos(friction_angle_rad), 2);
}

SoilEstimate estimateSoil(const EstimateOptions& options, const ProgressMonitor& watch) {
  if (options.whole_equation && options.method != "linear-offset") {
    throw InputError({.where = "--keep-m1",
                      .reason = "it is a term of linear-offset",
                      .remedy = "use --method linear-offset, or leave it out"});
  }
  if (options.plate_width_m > 0.0 && options.method != "bevameter") {
    throw InputError({.where = "--plate-width",
                      .reason = "it is a plate's",
                      .remedy = "use --method bevameter, or leave it out"});
  }
  if (!options.model.empty()) return modelEstimate(options, watch);
  if (options.method == "wong-reece") return posteriorEstimate(options, watch);
  if (options.method != "bevameter") return lineEstimate(options, watch);
  if (options.recursive) {
    throw InputError({.where = "--recursive",
                      .reason = "--method bevameter fits a whole test at once",
                      .remedy = "leave it out"});
  }
  return bevameterEstimate(options, watch);
}

}  // namespace talus::cli
