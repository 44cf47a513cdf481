#include <cmath>

#include <fmt/format.h>

#include <talus/terramech/io/model_file.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/io/telemetry_reader.hpp>
#include <talus/terramech/io/wheel_rows.hpp>
#include <talus/terramech/tables/model_estimate.hpp>
#include <talus/terramech/trace/model_soil.hpp>

namespace talus::terramech {
namespace {

constexpr double kMisfit = 3.0;  // above it the model does not describe the rows

RefinedModel modelOf(const EstimateOptions& options) {
  RefinedModel model = (options.model.empty() ? unknownSoil() : loadModel(options.model)).model;
  if (model.base != BaseModel::WongReece)
    throw InputError({.where = options.model,
                      .reason = "its base is linear-formula, which has no soil",
                      .remedy = "use a model with the base wong-reece"});
  if (!options.rover.empty()) model.takeRover(loadRover(options.rover));
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

}  // namespace

bool measuresSideForce(const std::string& table) {
  const Telemetry rows = readTelemetry(table);
  const auto* angle = rows.find("slip_angle_rad");
  const auto* force = rows.find("side_force_N");
  if (angle == nullptr || force == nullptr) return false;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (std::abs((*angle)[k]) > kStraightUpTo_rad && std::isfinite((*force)[k])) return true;
  return false;
}

SoilEstimate modelEstimate(const EstimateOptions& options, const ProgressMonitor& watch) {
  refuseWhatDoesNotGo(options);
  RefinedModel model = modelOf(options);
  TelemetryOptions reading{.required = {"load_N", "slip"}};
  if (model.wheel) reading.wheel_radius_m = model.wheel->radius_m;
  const Telemetry telemetry = readTelemetry(options.table, reading, watch);
  const Trial all = makeTrial(telemetry, model);
  std::vector<char> above = beyondAxle(all);
  for (char& row : above) row = !row;
  const Trial trial = subset(all, above);
  if (trial.rows() == 0)
    throw InputError(
        {.where = options.table, .reason = "in every row the sinkage reaches the axle", .remedy = ""});
  model.slip_along_travel |= slipIsAlongTravel(trial.states);
  const ModelSoil found = soilUnder(model, trial, howOf(options));
  SoilEstimate estimate;
  estimate.rejected = telemetry.rejected;
  estimate.rows_used = static_cast<std::size_t>(trial.rows());
  estimate.cohesion_Pa = found.soil.cohesion_Pa;
  estimate.friction_angle_rad = found.soil.friction_angle_rad;
  estimate.tan_friction = std::tan(found.soil.friction_angle_rad);
  estimate.shear_modulus_m = found.soil.shear_modulus_m;
  estimate.covariance = found.strength_covariance;
  estimate.sinkage_exponent = found.soil.sinkage_exponent;
  estimate.cohesive_modulus = found.soil.cohesive_modulus;
  estimate.frictional_modulus = found.soil.frictional_modulus;
  estimate.unseen = found.unseen;
  for (const Effect& effect : model.effects) estimate.effects.push_back(effect.name);
  if (found.misfit > kMisfit)
    estimate.warnings.push_back(fmt::format(
        "{}no soil explains the readings (misfit {:.1f}, 1 expected); trace these rows, or increase --noise",
        options.model.empty() ? "" : "with the effects of " + options.model + " ", found.misfit));
  if (trial.rows() < all.rows())
    estimate.warnings.push_back(
        fmt::format("{} rows with sinkage at or above the axle were excluded", all.rows() - trial.rows()));
  return estimate;
}

}  // namespace talus::terramech
