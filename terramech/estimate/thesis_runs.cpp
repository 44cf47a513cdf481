#include <cmath>

#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/estimate/thesis_runs.hpp>
#include <talus/terramech/numerics/normal_distribution.hpp>

namespace talus::terramech {

// Uniform in (0, 1) from the top 53 bits, never 0. Distributions of the standard library differ between
// implementations.
double ThesisRuns::even() {
  return (static_cast<double>(random_() >> 11U) + 0.5) * 0x1p-53;
}

double ThesisRuns::normal() {
  return normalQuantile(even());
}

ThesisRun ThesisRuns::next(const ThesisRunOptions& options) {
  static const SoilMixture classes = thesisSoils();
  ThesisRun run;
  run.soil_class = static_cast<int>(random_() % classes.size());
  SoilVector y;
  for (double& value : y) value = even();
  run.soil = classes[static_cast<std::size_t>(run.soil_class)].at(y);
  const Soil soil = soilOf(run.soil);
  const auto noisy = [&](double value) { return value * (1.0 + options.noise * normal()); };
  for (int k = 0; k < options.samples; ++k) {
    const double slip = 0.2 + 0.1 * (6 - std::abs(k % 12 - 6));
    const double load = options.load_scale * (60.0 + 40.0 * even());
    const WheelForces f = equilibrium(soil, options.wheel, {.load_N = load, .slip = slip});
    const WheelSample truth{load, f.torque_Nm, f.sinkage_m, slip};
    run.truth.push_back(truth);
    run.pull_over_load.push_back(f.drawbar_pull_N / load);
    run.samples.push_back({noisy(load), noisy(f.torque_Nm), noisy(f.sinkage_m), noisy(slip)});
  }
  return run;
}

Soil soilOf(const ContactSoil& contact) {
  return {.name = "contact",
          .cohesion_Pa = contact.cohesion_Pa,
          .friction_angle_rad = contact.friction_angle_rad,
          .sinkage_exponent = contact.sinkage_exponent,
          .cohesive_modulus = 0.0,
          .frictional_modulus = contact.sinkage_modulus,
          .shear_modulus_m = contact.shear_modulus_m,
          .c1 = contact.c1,
          .c2 = contact.c2};
}

}  // namespace talus::terramech
