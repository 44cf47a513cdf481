#pragma once

#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/estimate/pull_forecast.hpp>

/// The true drawbar pull of a base or refined model (ours); predict() gives the readings of the sensors.
namespace talus::terramech {

/// Whether an effect changes what a sensor reads and nothing of the contact.
bool isSensorFault(const Effect& effect);

/// The model without the faults of its sensors: no offset or drift of a reading, no scatter of the answers.
/// What the readings of slip and load leave open stays, and so does the covariance of what was fitted. Where
/// nothing was fitted, the soil's prior takes the place of that covariance.
RefinedModel groundTruthOf(const RefinedModel& model);

/// DP/W and z/r of a wheel.
struct ModelPull {
  Estimate pull_over_load;
  Estimate sinkage_over_radius;
  double torque_over_load_radius = 0.0;
};

/// Of a model from groundTruthOf(), at the state's own load and slip. Never throws on a state that
/// validate()s.
ModelPull pullOf(const RefinedModel& truth, const WheelState& state);

/// The same carried to the reference slip, in (0, 1], and to the slip of greatest pull, where the slip is
/// chosen and not read. Throws std::invalid_argument for a reference slip out of range.
PullForecast forecastPull(const RefinedModel& truth, const WheelState& state, double reference_slip = 0.5);

}  // namespace talus::terramech
