#pragma once

#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/estimate/pull_forecast.hpp>

/// True drawbar pull of a base or refined model, without sensor errors (ours); predict() returns the readings
/// with sensor errors.
namespace talus::terramech {

/// Returns true if an effect changes a sensor reading and leaves the contact unchanged.
bool isSensorFault(const Effect& effect);

/// Returns the model without sensor errors: no offset or drift of a reading, no noise of the channels. The
/// errors of slip and load and the covariance of the fitted parameters remain. If no parameter was fitted,
/// the soil's prior is used as covariance.
RefinedModel groundTruthOf(const RefinedModel& model);

/// Drawbar pull DP/W, sinkage z/r and torque T/(rW) of a wheel, as ratios [-].
struct ModelPull {
  Estimate pull_over_load;
  Estimate sinkage_over_radius;
  double torque_over_load_radius = 0.0;
};

/// Returns the pull of a model from groundTruthOf() at the load and slip of the state. Never throws for a
/// valid state.
ModelPull pullOf(const RefinedModel& truth, const WheelState& state);

/// Returns the pull at the reference slip, in (0, 1], and at the slip of maximum pull among kForecastSlips.
/// The slip is an exact input without reading error. Throws std::invalid_argument for a reference slip
/// outside (0, 1].
PullForecast forecastPull(const RefinedModel& truth, const WheelState& state, double reference_slip = 0.5);

}  // namespace talus::terramech
