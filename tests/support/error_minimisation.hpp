#pragma once

#include <cmath>
#include <span>
#include <vector>

#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/strength/shear_modulus.hpp>

namespace talus::terramech {

/// Returns the error criterion Err(K_e) of a trial value K_e = shear_modulus_m: the sum of the distances of
/// the points (M3, M4) from the line fitted to them [Pa] (thesis Eq. D.2).
inline double modulusError_Pa(const Wheel& wheel, std::span<const WheelSample> samples,
                              double shear_modulus_m) {
  std::vector<StressPair> points;
  MohrCoulombLine line;
  for (const WheelSample& s : samples) {
    points.push_back(linearOffset(wheel, s, shear_modulus_m).pair());
    line.add(points.back());
  }
  const ShearStrength fit = line.estimate();
  double sum = 0.0;
  for (const auto& [x, y] : points) sum += std::abs(y - fit.cohesion_Pa - fit.tan_friction * x);
  return sum / std::hypot(1.0, fit.tan_friction);
}

/// Returns the K_e at the global minimum of Err(K_e) from 2 to 100 mm (method D.1 of the thesis).
inline ModulusEstimate modulusByErrorMinimisation(const Wheel& wheel, std::span<const WheelSample> samples) {
  const Minimum best =
      globalMinimum([&](double k) { return modulusError_Pa(wheel, samples, k); }, 0.002, 0.1);
  return {.shear_modulus_m = best.at,
          .error = best.value,
          .at_bound = best.at < 1.001 * 0.002 || best.at > 0.999 * 0.1};
}

}  // namespace talus::terramech
