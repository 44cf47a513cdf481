#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <cli/bevameter_table.hpp>
#include <cli/soil_estimate.hpp>
#include <terramech/iagnemma.hpp>
#include <terramech/linear_offset.hpp>
#include <terramech/shear_modulus.hpp>
#include <terramech/soil_library.hpp>
#include <terramech/sojourner.hpp>
#include <terramech/telemetry_reader.hpp>

namespace talus::cli {
namespace {

using namespace terramech;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// --shear-modulus: a number in metres, if it is one.
std::optional<double> statedModulus(const EstimateOptions& options) {
  const std::string& word = options.shear_modulus;
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  if (value > 0.0 && std::isfinite(value)) return value;
  throw InputError({.where = "--shear-modulus " + word, .reason = "must be > 0 [m]", .remedy = ""});
}

// The file's own column, where it has one value in all rows.
std::optional<double> columnModulus(const EstimateOptions& options) {
  if (!options.shear_modulus.empty()) return std::nullopt;
  const Telemetry table = readTelemetry(options.table);
  const auto* column = table.find("shear_modulus_m");
  if (column == nullptr || column->empty() || !(column->front() > 0.0)) return std::nullopt;
  for (const double k : *column) {
    if (k != column->front()) return std::nullopt;
  }
  return column->front();
}

double modulusFrom(const EstimateOptions& options, const WheelRows& rows, SoilEstimate& estimate) {
  if (const auto stated = statedModulus(options)) return *stated;
  if (const auto column = columnModulus(options)) return *column;
  const std::string& how = options.shear_modulus;
  const ModulusEstimate k = how == "error-minimisation" ? modulusByErrorMinimisation(rows.wheel, rows.samples)
                            : how == "effective-torque" ? modulusByTorqueRatio(rows.wheel, rows.samples)
                            : how == "effective-torque-printed"
                                ? modulusByEffectiveTorque(rows.wheel, rows.samples)
                                : modulusJointly(rows.wheel, rows.samples);
  if (k.at_bound) {
    estimate.unseen.emplace_back(
        "shear_modulus_m: no best value between 2 and 100 mm; vary the slip, or state it");
  }
  return k.shear_modulus_m;
}

void take(const ShearStrength& fit, SoilEstimate& estimate) {
  estimate.cohesion_Pa = fit.cohesion_Pa;
  estimate.tan_friction = fit.tan_friction;
  estimate.friction_angle_rad = fit.frictionAngle_rad();
  estimate.covariance = fit.covariance;
  estimate.unseen.insert(estimate.unseen.end(), fit.unseen.begin(), fit.unseen.end());
}

SoilEstimate lineEstimate(const EstimateOptions& options, const Watch& watch) {
  const bool spin = options.method == "sojourner";
  const WheelRows rows = readWheelRows(options.table, {.rover = options.rover, .needs_slip = !spin}, watch);
  SoilEstimate estimate;
  estimate.rejected = rows.rejected;
  estimate.rows_used = rows.samples.size();
  const double modulus = spin ? kNan : modulusFrom(options, rows, estimate);
  MohrCoulombLine line;
  LinearOffsetFit whole;
  for (const WheelSample& s : rows.samples) {
    if (options.method == "linear-offset") whole.add(linearOffset(rows.wheel, s, modulus));
    estimate.points.push_back(spin                           ? sojournerPair(rows.wheel, s)
                              : options.method == "iagnemma" ? iagnemmaPair(rows.wheel, s, modulus)
                                                             : linearOffset(rows.wheel, s, modulus).pair());
    line.add(estimate.points.back());
  }
  take(line.estimate(), estimate);
  estimate.shear_modulus_m = modulus;
  return estimate;
}

Marginal marginal(double mean, double std, double least) {
  return std > 0.0 ? Marginal::normal(mean, std, least) : Marginal::fixed(mean);
}

SoilClass classOf(const SoilPrior& p, double width_m) {
  const Soil& m = p.mean;
  const SoilDeviation& d = p.deviation;
  SoilClass soil{.name = m.name, .probability = 1.0, .parameters = {}, .c1 = m.c1, .c2 = m.c2};
  soil.parameters[kCohesion] = marginal(m.cohesion_Pa, d.cohesion_Pa, 0.0);
  soil.parameters[kFriction] = marginal(m.friction_angle_rad, d.friction_angle_rad, 0.01);
  soil.parameters[kExponent] = marginal(m.sinkage_exponent, d.sinkage_exponent, 0.05);
  const double modulus = sinkageModulus(m, width_m);
  soil.parameters[kModulus] =
      marginal(modulus, std::hypot(d.cohesive_modulus / width_m, d.frictional_modulus), 1e-3 * modulus);
  soil.parameters[kShear] = marginal(m.shear_modulus_m, d.shear_modulus_m, 1e-4);
  return soil;
}

SoilMixture priorOf(const EstimateOptions& options, double width_m) {
  if (options.prior.empty()) return thesisSoilsOrOther();
  SoilMixture mixture;
  const auto library = librarySoils();
  if (std::ranges::find(library, options.prior) != library.end()) {
    mixture.push_back(classOf(loadSoilPrior(options.prior), width_m));
  } else {
    for (const SoilPrior& soil : loadSoils(options.prior)) mixture.push_back(classOf(soil, width_m));
  }
  for (SoilClass& soil : mixture) soil.probability = 1.0 / static_cast<double>(mixture.size());
  return mixture;
}

SoilEstimate posteriorEstimate(const EstimateOptions& options, const Watch& watch) {
  const WheelRows rows = readWheelRows(options.table, {.rover = options.rover, .needs_slip = true}, watch);
  SoilMixture prior = priorOf(options, rows.wheel.width_m);
  if (const auto stated = statedModulus(options)) {
    for (SoilClass& soil : prior) soil.parameters[kShear] = Marginal::fixed(*stated);
  }
  SoilEstimate estimate;
  estimate.rejected = rows.rejected;
  estimate.rows_used = rows.samples.size();
  SoilFitOptions fit;
  fit.noise = ReadingErrors::relative(options.noise);
  fit.draws = 512;
  estimate.posterior = fitSoil(rows.wheel, rows.samples, prior, fit);
  const SoilPosterior& p = *estimate.posterior;
  estimate.cohesion_Pa = p.mean.cohesion_Pa;
  estimate.friction_angle_rad = p.mean.friction_angle_rad;
  estimate.tan_friction = p.tan_friction;
  estimate.shear_modulus_m = p.mean.shear_modulus_m;
  estimate.covariance = p.strength_covariance;
  estimate.sinkage_exponent = p.mean.sinkage_exponent;
  estimate.frictional_modulus = p.mean.sinkage_modulus;
  estimate.unseen = p.unseen;
  for (const SoilClass& soil : prior) estimate.class_names.push_back(soil.name);
  return estimate;
}

SoilEstimate bevameterEstimate(const EstimateOptions& options, const Watch& watch) {
  const BevameterTable table = readBevameterTable(options.table, watch);
  SoilEstimate estimate;
  estimate.rejected = table.rejected;
  estimate.rows_used = table.shear.size() + table.plates.size();
  if (!table.shear.empty()) {
    const ShearFit fit = fitShear(table.shear);
    take(fit.strength, estimate);
    estimate.shear_modulus_m = fit.shear_modulus_m;
    if (fit.modulus_at_bound)
      estimate.unseen.emplace_back("shear_modulus_m: the displacements do not show it");
    for (const ShearReading& r : table.shear) {
      const double share = -std::expm1(-r.displacement_m / fit.shear_modulus_m);
      estimate.points.push_back({.normal_Pa = r.normal_Pa, .shear_Pa = r.shear_Pa / share});
    }
  }
  if (!table.plates.empty()) {
    PressureSinkageFit fitter;
    for (const PlateReading& r : table.plates) fitter.add(r);
    const PressureSinkage fit = fitter.estimate();
    estimate.sinkage_exponent = fit.sinkage_exponent;
    estimate.cohesive_modulus = fit.cohesive_modulus;
    estimate.frictional_modulus = fit.frictional_modulus;
    if (!fit.refused.empty())
      estimate.unseen.push_back("cohesive_modulus, frictional_modulus: " + fit.refused);
  }
  return estimate;
}

}  // namespace

SoilEstimate::SoilEstimate()
    : cohesion_Pa(kNan),
      tan_friction(kNan),
      shear_modulus_m(kNan),
      covariance(Eigen::Matrix2d::Constant(kNan)),
      friction_angle_rad(kNan),
      sinkage_exponent(kNan) {}

SoilEstimate estimateSoil(const EstimateOptions& options, const Watch& watch) {
  if (!options.prior.empty() && options.method != "wong-reece") {
    throw InputError({.where = "--prior " + options.prior,
                      .reason = fmt::format("--method {} takes no prior", options.method),
                      .remedy = "use --method wong-reece"});
  }
  if (options.method == "bevameter") return bevameterEstimate(options, watch);
  if (options.method == "wong-reece") return posteriorEstimate(options, watch);
  return lineEstimate(options, watch);
}

}  // namespace talus::cli
