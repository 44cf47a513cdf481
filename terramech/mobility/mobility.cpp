#include <algorithm>
#include <numbers>
#include <stdexcept>

#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/mobility/mobility.hpp>
#include <talus/terramech/mobility/steady_wheel.hpp>
#include <talus/terramech/numerics/range.hpp>

namespace talus::terramech {
namespace {

void require(const Rover& rover, const MobilityOptions& options) {
  validate(rover);
  const RangeCheck check{"mobility options"};
  check.within("reference_slip", options.reference_slip, {1e-6, 1.0 - 1e-6});
  check.atLeast("pass", options.pass, 1.0);
}

MobilityReference referenceBy(const WheelForces& f, const Rover& rover, double slip) {
  const double load_N = wheelLoad_N(rover), radius_m = rover.wheel.radius_m;
  return {slip, f.drawbar_pull_N / load_N, std::min(f.sinkage_m / radius_m, 1.0),
          f.torque_Nm / (load_N * radius_m)};
}

// Forces of a wheel; sunk to its axle if the soil cannot carry it.
WheelForces forcesOn(const Soil& soil, const Rover& rover, double slip) {
  const WheelOperation operation{.load_N = wheelLoad_N(rover), .slip = slip};
  try {
    return equilibrium(soil, rover.wheel, operation);
  } catch (const std::domain_error&) {
    return forcesAtEntry(soil, rover.wheel, {.slip = slip}, 0.5 * std::numbers::pi).forces;
  }
}

}  // namespace

MobilityReference mobilityReference(const Soil& soil, const Rover& rover, const MobilityOptions& options) {
  validate(soil);
  require(rover, options);
  return referenceBy(forcesOn(soil, rover, options.reference_slip), rover, options.reference_slip);
}

MobilityReference mobilityReference(const RefinedModel& model, const Rover& rover,
                                    const MobilityOptions& options) {
  validate(model.soil);
  if (model.base == BaseModel::LinearFormula)
    throw std::invalid_argument(
        "model 'linear-formula' computes drawbar pull from a measured torque and cannot predict slip on a "
        "slope; trace the data with model: wong-reece");
  require(rover, options);
  WheelState state = steadyWheel(rover, wheelLoad_N(rover), options.reference_slip);
  state.pass_index = options.pass;
  state.slope_rad = 0.0;
  const Reading reading = predict(withoutSensors(model), state);
  return referenceBy({.sinkage_m = reading.sinkage_m,
                      .entry_angle_rad = 0.0,
                      .torque_Nm = reading.torque_Nm,
                      .drawbar_pull_N = reading.drawbar_pull_N},
                     rover, options.reference_slip);
}

}  // namespace talus::terramech
