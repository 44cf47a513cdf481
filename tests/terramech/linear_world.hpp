#pragma once

#include <vector>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

/// Readings of a wheel with exactly the stresses that the linear-offset method assumes, for which the
/// estimators of the method are exact. For tests.
namespace talus::terramech {

struct LinearWorld {
  double cohesion_Pa = 3000.0;
  double tan_friction = 0.5;
  double shear_modulus_m = 0.02;
  double sigma_m_Pa = 20000.0;
  bool offset = true;  ///< false: Iagnemma's assumption, no shear at the bottom
};

/// Load and torque from the stresses of Eq. 2.1 by the midpoint rule (1e-7), independent of the closed forms
/// under test.
inline WheelSample sampleOf(const Wheel& wheel, const LinearWorld& world, WheelSample at) {
  const double theta_1 = entryAngle_rad(wheel, at.sinkage_m);
  const double h = 0.5 * theta_1;
  const auto [a, b] = mobilisation(wheel, at, world.shear_modulus_m);
  const double tau_m = (world.cohesion_Pa + world.sigma_m_Pa * world.tan_friction) * a;
  const double tau_offset = world.offset ? world.cohesion_Pa * b : 0.0;
  constexpr int kSteps = 20000;
  at.load_N = at.torque_Nm = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    const double t = theta_1 * (k + 0.5) / kSteps;
    const double triangle = t < h ? t / h : (theta_1 - t) / h;
    const double sigma = world.sigma_m_Pa * triangle;
    const double tau = tau_m * triangle + (t < h ? tau_offset * (1.0 - t / h) : 0.0);
    const double area = wheel.radius_m * wheel.width_m * theta_1 / kSteps;
    at.load_N += area * (sigma * std::cos(t) + tau * std::sin(t));
    at.torque_Nm += area * wheel.radius_m * tau;
  }
  return at;
}

/// Ten samples of slip 0.2 to 0.8 with varying peak stress, as under a varying load.
inline std::vector<WheelSample> linearSamples(const Wheel& wheel, LinearWorld world) {
  std::vector<WheelSample> samples;
  for (int k = 0; k < 10; ++k) {
    world.sigma_m_Pa = 16000.0 + 1200.0 * ((k * 7) % 10);
    samples.push_back(sampleOf(wheel, world, {.sinkage_m = 0.012 + 0.001 * k, .slip = 0.2 + 0.06 * k}));
  }
  return samples;
}

}  // namespace talus::terramech
