#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <terramech/soil_mixture.hpp>
#include <terramech/wheel_sample.hpp>
#include <terramech/wong_reece.hpp>

/// Soils drawn from thesis Table 2.1 and wheel samples on them, by the exact forward model. For tests.
namespace talus::terramech {

inline const Wheel kThesisWheel{.radius_m = 0.1, .width_m = 0.1};

struct SimulatedRun {
  ContactSoil soil;
  int soil_class = 0;
  std::vector<WheelSample> samples;
  std::vector<double> pull_over_load;  ///< true DP/W of each
};

/// `count` samples in the thesis' pattern: slip 0.2 to 0.8 and back in steps of 0.1, load 60 to 100 N, each
/// reading with the given relative Gaussian error.
inline SimulatedRun simulateRun(std::mt19937_64& random, double noise, int count = 10,
                                const Wheel& wheel = kThesisWheel) {
  std::uniform_real_distribution<double> even;
  std::normal_distribution<double> normal;
  SimulatedRun run;
  run.soil_class = static_cast<int>(random() % 4);
  SoilVector y;
  for (double& value : y) value = even(random);
  run.soil = thesisSoils()[static_cast<std::size_t>(run.soil_class)].at(y);
  const Soil soil{.name = "simulated",
                  .cohesion_Pa = run.soil.cohesion_Pa,
                  .friction_angle_rad = run.soil.friction_angle_rad,
                  .sinkage_exponent = run.soil.sinkage_exponent,
                  .frictional_modulus = run.soil.sinkage_modulus,
                  .shear_modulus_m = run.soil.shear_modulus_m};
  const auto noisy = [&](double value) { return value * (1.0 + noise * normal(random)); };
  for (int k = 0; k < count; ++k) {
    const double slip = 0.2 + 0.1 * (6 - std::abs(k % 12 - 6));
    const double load = 60.0 + 40.0 * even(random);
    const WheelForces f = equilibrium(soil, wheel, {.load_N = load, .slip = slip});
    run.pull_over_load.push_back(f.drawbar_pull_N / load);
    run.samples.push_back({noisy(load), noisy(f.torque_Nm), noisy(f.sinkage_m), noisy(slip)});
  }
  return run;
}

}  // namespace talus::terramech
