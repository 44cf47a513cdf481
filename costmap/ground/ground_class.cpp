#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include <talus/costmap/ground/ground_model.hpp>

namespace talus::costmap {
namespace {

using terramech::Soil;
using terramech::SoilDeviation;

constexpr std::array<std::pair<double Soil::*, double SoilDeviation::*>, 7> kFields{
    {{&Soil::cohesion_Pa, &SoilDeviation::cohesion_Pa},
     {&Soil::friction_angle_rad, &SoilDeviation::friction_angle_rad},
     {&Soil::sinkage_exponent, &SoilDeviation::sinkage_exponent},
     {&Soil::cohesive_modulus, &SoilDeviation::cohesive_modulus},
     {&Soil::frictional_modulus, &SoilDeviation::frictional_modulus},
     {&Soil::shear_modulus_m, &SoilDeviation::shear_modulus_m},
     {&Soil::slip_sinkage_exponent, &SoilDeviation::slip_sinkage_exponent}}};

// Step of the central difference, in standard deviations: a half keeps parameters near their bounds in range.
constexpr double kStep = 0.5;

// Standard deviation of the exponent of underGravity(): ours.
constexpr double kGravityExponentStd = 0.5;

double pullOf(const Soil& soil, const terramech::Rover& rover) {
  return terramech::mobilityReference(soil, rover).drawbar_pull_over_load;
}

bool isStiffer(const Soil& tested, const terramech::Rover& rover) {
  return tested.test_gravity_m_s2 > rover.gravity_m_s2;
}

// The soil on the rover's body for a gravity exponent lower by one standard deviation.
Soil lessAffected(const Soil& tested, const terramech::Rover& rover) {
  return underGravity(tested, rover.gravity_m_s2, 1.0 - kGravityExponentStd);
}

// Converts the prior to the gravity of the rover.
terramech::SoilPrior onBody(terramech::SoilPrior prior, const terramech::Rover& rover) {
  if (!isStiffer(prior.mean, rover)) return prior;
  const double width = rover.wheel.width_m, tested = sinkageModulus(prior.mean, width);
  prior.mean = underGravity(prior.mean, rover.gravity_m_s2);
  const double factor = sinkageModulus(prior.mean, width) / tested;
  prior.deviation.cohesion_Pa *= factor;
  prior.deviation.cohesive_modulus *= factor;
  prior.deviation.frictional_modulus *= factor;
  return prior;
}

}  // namespace

GroundClass groundClass(int number, const terramech::SoilPrior& tested, const terramech::Rover& rover) {
  const terramech::SoilPrior prior = onBody(tested, rover);
  GroundClass ground;
  ground.number = number;
  ground.soil = prior.mean;
  ground.rut_stiffness_std = prior.deviation.rut_stiffness;
  double variance = 0.0;
  for (const auto& [value, deviation] : kFields) {
    const double std = prior.deviation.*deviation;
    if (std <= 0.0) continue;
    Soil more = prior.mean, less = prior.mean;
    more.*value += kStep * std;
    less.*value = std::max(less.*value - kStep * std, 1e-3 * prior.mean.*value);
    try {
      const double slope = (pullOf(more, rover) - pullOf(less, rover)) / (more.*value - less.*value);
      variance += slope * std * slope * std;
    } catch (const std::invalid_argument& e) {
      std::ostringstream text;
      text << e.what() << "; it is the mean " << prior.mean.*value << " with half of its std " << std;
      throw std::invalid_argument(text.str());
    }
  }
  if (variance > 0.0) ground.mean_std = std::sqrt(variance);
  if (isStiffer(tested.mean, rover))
    ground.mean_std = std::hypot(ground.mean_std,
                                 pullOf(lessAffected(tested.mean, rover), rover) - pullOf(prior.mean, rover));
  return ground;
}

GroundClass groundClass(int number, const terramech::RefinedModel& tested, const terramech::Rover& rover) {
  terramech::RefinedModel model = tested;
  model.soil = underGravity(tested.soil, rover.gravity_m_s2);
  const auto pull = [&](const terramech::RefinedModel& m) {
    return terramech::mobilityReference(m, rover).drawbar_pull_over_load;
  };
  GroundClass ground;
  ground.number = number;
  ground.soil = model.soil;
  ground.effects = terramech::withoutSensors(model).effects;
  const double here = pull(model);
  const std::size_t count = model.covariance.empty() ? 0 : model.fitted.size();
  std::vector<double> slope;
  for (std::size_t k = 0; k < count; ++k) {
    const double std = std::sqrt(std::max(0.0, model.covariance[k * count + k]));
    terramech::RefinedModel moved = model;
    terramech::setValue(moved, model.fitted[k], terramech::value(model, model.fitted[k]) + 0.1 * std);
    slope.push_back(std > 0.0 ? (pull(moved) - here) / (0.1 * std) : 0.0);
  }
  double variance = 0.0;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j) variance += slope[i] * model.covariance[i * count + j] * slope[j];
  if (variance > 0.0) ground.mean_std = std::sqrt(variance);
  model.soil = lessAffected(tested.soil, rover);
  if (isStiffer(tested.soil, rover)) ground.mean_std = std::hypot(ground.mean_std, pull(model) - here);
  return ground;
}

}  // namespace talus::costmap
