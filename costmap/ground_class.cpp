#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <costmap/ground_class.hpp>

namespace talus::costmap {
namespace {

using terramech::Soil;
using terramech::SoilDeviation;

constexpr std::array<std::pair<double Soil::*, double SoilDeviation::*>, 6> kFields{
    {{&Soil::cohesion_Pa, &SoilDeviation::cohesion_Pa},
     {&Soil::friction_angle_rad, &SoilDeviation::friction_angle_rad},
     {&Soil::sinkage_exponent, &SoilDeviation::sinkage_exponent},
     {&Soil::cohesive_modulus, &SoilDeviation::cohesive_modulus},
     {&Soil::frictional_modulus, &SoilDeviation::frictional_modulus},
     {&Soil::shear_modulus_m, &SoilDeviation::shear_modulus_m}}};

// Half the deviation each way keeps parameters in range that are a few deviations from their bound.
constexpr double kStep = 0.5;

double pullOf(const Soil& soil, const terramech::Rover& rover) {
  return terramech::MobilityCurve(soil, rover).reference().drawbar_pull_over_load;
}

}  // namespace

GroundClass groundClass(int number, const terramech::SoilPrior& prior, const terramech::Rover& rover) {
  GroundClass ground;
  ground.number = number;
  ground.soil = prior.mean;
  double variance = 0.0;
  for (const auto& [value, deviation] : kFields) {
    const double std = prior.deviation.*deviation;
    if (std <= 0.0) continue;
    Soil more = prior.mean, less = prior.mean;
    more.*value += kStep * std;
    less.*value = std::max(less.*value - kStep * std, 1e-3 * prior.mean.*value);
    const double slope = (pullOf(more, rover) - pullOf(less, rover)) / (more.*value - less.*value);
    variance += slope * std * slope * std;
  }
  if (variance > 0.0) ground.mean_std = std::sqrt(variance);
  return ground;
}

}  // namespace talus::costmap
