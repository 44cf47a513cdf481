#pragma once

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/terramech/estimate/soil_prior.hpp>

namespace talus::costmap {

/// Returns the terrain class number `number` for a soil prior and a rover. GroundClass::mean_std is the
/// standard deviation of drawbar pull over load DP/W at the reference slip 0.5, by first-order propagation of
/// the standard deviations of cohesion, friction angle, sinkage exponent, moduli, shear modulus and
/// slip-sinkage exponent as independent parameters; a prior without standard deviations keeps GroundClass's
/// default. A soil that was tested in greater gravity is converted by underGravity(); mean_std then includes
/// the effect of a gravity exponent of 0.5 instead of 1. Throws std::invalid_argument if MobilityCurve
/// rejects the soil or the rover.
GroundClass groundClass(int number, const terramech::SoilPrior& prior, const terramech::Rover& rover);

/// Returns the terrain class number `number` for a refined model (soil and effects fitted to wheel data) and
/// a rover. mean_std is the standard deviation of DP/W at the reference slip by the model's covariance; a
/// model without a covariance keeps GroundClass's default. Sensor effects are omitted. Gravity is converted
/// as for a soil prior. Throws std::invalid_argument if MobilityCurve rejects the soil or the rover.
GroundClass groundClass(int number, const terramech::RefinedModel& model, const terramech::Rover& rover);

}  // namespace talus::costmap
