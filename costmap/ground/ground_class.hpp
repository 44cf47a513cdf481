#pragma once

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/terramech/estimate/soil_prior.hpp>

namespace talus::costmap {

/// Ground class of a soil prior on a rover. mean_std is the standard deviation of drawbar pull over load at
/// the reference slip, by first-order propagation of the stated deviations of cohesion, friction, sinkage
/// exponent, moduli, shear modulus and slip-sinkage exponent as independent parameters; a prior without
/// deviations keeps GroundClass's default. A soil that was tested in greater gravity is converted by
/// underGravity(), and mean_std then includes the effect of a gravity exponent of 0.5 instead of 1. Throws
/// std::invalid_argument as MobilityCurve.
GroundClass groundClass(int number, const terramech::SoilPrior& prior, const terramech::Rover& rover);

/// Ground class of a refined model on a rover. mean_std is the standard deviation of drawbar pull over load
/// at the reference slip by the model's covariance; a model without a covariance keeps GroundClass's default.
/// Sensor effects are omitted; gravity as for a soil prior. Throws std::invalid_argument as MobilityCurve.
GroundClass groundClass(int number, const terramech::RefinedModel& model, const terramech::Rover& rover);

}  // namespace talus::costmap
