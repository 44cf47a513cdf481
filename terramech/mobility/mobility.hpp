#pragma once

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Wheel of a MobilityReference.
struct MobilityOptions {
  double reference_slip = 0.5;  ///< slip at which traversability is assessed, (0, 1) (thesis 3.5)
  int pass = 1;                 ///< pass number of the wheel over its track, >= 1, for multipass effects
};

/// State of a wheel with load W and radius r at a given slip on level ground.
struct MobilityReference {
  double slip = 0.0;                     ///< the given slip [-]
  double drawbar_pull_over_load = 0.0;   ///< drawbar pull over load, DP/W [-]
  double sinkage_over_radius = 0.0;      ///< sinkage over radius, z/r [-]; 1: the soil cannot carry the wheel
  double torque_over_load_radius = 0.0;  ///< torque ratio T/(rW) [-]
};

/// Return the state of a wheel of a rover at the reference slip, the input of categorise(). A model acts
/// without its sensor errors; its effects act only if their covariates are known: speed, rim speed (the rover's
/// maximum), pass and slope 0. Throw std::invalid_argument for a soil, rover or option out of range, and for the
/// base model linear-formula, which needs a measured torque.
MobilityReference mobilityReference(const Soil& soil, const Rover& rover,
                                    const MobilityOptions& options = {});
MobilityReference mobilityReference(const RefinedModel& model, const Rover& rover,
                                    const MobilityOptions& options = {});

}  // namespace talus::terramech
