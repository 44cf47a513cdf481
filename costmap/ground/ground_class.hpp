#pragma once

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/terramech/estimate/soil_prior.hpp>

namespace talus::costmap {

/// The class of a soil prior on a rover. Its mean_std is what the stated deviations of cohesion, friction,
/// sinkage exponent, moduli and shear modulus make of drawbar pull over load at the reference slip, to first
/// order and independent; a prior that states none keeps GroundClass's default. Where the soil was tested in greater gravity it is
/// as underGravity() has it, and what an exponent of 0.5 in place of 1 makes of the pull adds to mean_std. Throws
/// std::invalid_argument as MobilityCurve does.
GroundClass groundClass(int number, const terramech::SoilPrior& prior, const terramech::Rover& rover);

/// The class of a refined model on a rover. Its mean_std is what the model's covariance makes of drawbar pull
/// over load at the reference slip; a model without one keeps GroundClass's default. Effects of sensors are
/// left out; gravity as above. Throws std::invalid_argument as MobilityCurve does.
GroundClass groundClass(int number, const terramech::RefinedModel& model, const terramech::Rover& rover);

}  // namespace talus::costmap
