#pragma once

#include <cmath>
#include <cstdlib>

#include <thesis_runs.hpp>

#include <talus/terramech/contact/wheel_on_soil.hpp>

/// The likelihood of soil_estimation.hpp by quadrature instead of linearisation, for tests.
namespace talus::terramech {

inline double gaussian(double away, double std) {
  return std::exp(-0.5 * away * away / (std * std)) / std;
}

/// p(readings of one sample | soil) up to a factor, integrated over true sinkage and slip. Every error has
/// the standard deviation `noise` times the true value; the priors are uniform in log W and in slip.
/// Gauss-Hermite quadrature with weight exp(-x^2/2)/sqrt(2 pi), the inner seven of nine points (Abramowitz
/// and Stegun 25.10 scaled).
inline double exactLikelihood(const ContactSoil& soil, const WheelSample& read, double noise) {
  constexpr double kNode[] = {0.0, 1.023255663789133, 2.076847978677830, 3.205429002856470};
  constexpr double kShare[] = {0.4063492063492063, 0.2440975028949394, 0.0499164067652179,
                               0.0027891413212318};
  const auto load = [&](double z) { return contactForces(soil, kThesisWheel, {z, read.slip})[kLoad]; };
  // Density of the reading given the truth, over the density of the quadrature nodes.
  const auto against = [&](double truth, double reading) {
    return gaussian(truth - reading, noise * truth) / gaussian(truth - reading, noise * reading);
  };
  double sum = 0.0;
  for (int a = -3; a <= 3; ++a) {
    const double z = read.sinkage_m * (1.0 + noise * std::copysign(kNode[std::abs(a)], a));
    const double by_sinkage = std::log(load(1.001 * z) / load(0.999 * z)) / (0.002 * z) *
                              kShare[std::abs(a)] * against(z, read.sinkage_m);
    for (int b = -3; b <= 3; ++b) {
      const double slip = read.slip * (1.0 + noise * std::copysign(kNode[std::abs(b)], b));
      const ForceVector f = contactForces(soil, kThesisWheel, {z, slip});
      sum += by_sinkage * kShare[std::abs(b)] * against(slip, read.slip) *
             gaussian(read.load_N - f[kLoad], noise * f[kLoad]) *
             gaussian(read.torque_Nm - f[kTorque], noise * f[kTorque]);
    }
  }
  return sum;
}

}  // namespace talus::terramech
