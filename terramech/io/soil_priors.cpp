#include <algorithm>
#include <cmath>

#include <talus/terramech/io/soil_priors.hpp>
#include <talus/terramech/io/terramech_io.hpp>

namespace talus::terramech {
namespace {

Marginal marginal(double mean, double std, double least) {
  return std > 0.0 ? Marginal::normal(mean, std, least) : Marginal::fixed(mean);
}

SoilClass classOf(const SoilPrior& p, double width_m) {
  const Soil& m = p.mean;
  const SoilDeviation& d = p.deviation;
  SoilClass soil{.name = m.name, .probability = 1.0, .parameters = {}, .c1 = m.c1, .c2 = m.c2};
  soil.parameters[kCohesion] = marginal(m.cohesion_Pa, d.cohesion_Pa, 0.0);
  soil.parameters[kFriction] = marginal(m.friction_angle_rad, d.friction_angle_rad, 0.01);
  soil.parameters[kExponent] = marginal(m.sinkage_exponent, d.sinkage_exponent, 0.05);
  const double modulus = sinkageModulus(m, width_m);
  soil.parameters[kModulus] =
      marginal(modulus, std::hypot(d.cohesive_modulus / width_m, d.frictional_modulus), 1e-3 * modulus);
  soil.parameters[kShear] = marginal(m.shear_modulus_m, d.shear_modulus_m, 1e-4);
  return soil;
}

}  // namespace

std::vector<SoilPrior> soilPriors(const std::string& name_or_path) {
  if (name_or_path.empty()) return {};
  const auto library = librarySoils();
  if (std::ranges::find(library, name_or_path) != library.end()) return {loadSoilPrior(name_or_path)};
  return loadSoils(name_or_path);
}

SoilMixture mixtureOf(const std::vector<SoilPrior>& soils, double width_m) {
  SoilMixture mixture;
  for (const SoilPrior& soil : soils) mixture.push_back(classOf(soil, width_m));
  for (SoilClass& soil : mixture) soil.probability = 1.0 / static_cast<double>(mixture.size());
  return mixture;
}

std::vector<StrengthPrior> strengthPriors(const std::vector<SoilPrior>& soils) {
  std::vector<StrengthPrior> priors;
  priors.reserve(soils.size());
  for (const SoilPrior& soil : soils) priors.push_back(strengthPrior(soil));
  return priors;
}

double meanModulus(const std::vector<SoilPrior>& soils) {
  double sum = 0.0;
  for (const SoilPrior& soil : soils) sum += soil.mean.shear_modulus_m;
  return sum / static_cast<double>(soils.size());
}

}  // namespace talus::terramech
