#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/numerics/functions.hpp>

/// Simulated telemetry of the thesis (section 2.3): soils drawn from Table 2.1, and a wheel driven over them
/// with the slip pattern of the thesis.
namespace talus::terramech {

/// Wheel of the thesis: radius and width 0.1 m.
inline constexpr Wheel kThesisWheel{.radius_m = 0.1, .width_m = 0.1};

/// Soil class of Table 2.1. Its parameters are uniform in their ranges; n is in 0.5 to 1.2 and K in 10 to 30 mm
/// for all classes.
struct ThesisSoil {
  const char* name;
  Interval cohesion_kPa, friction_deg, modulus_MN;  ///< modulus: k of a wheel, as k_phi

  /// Returns the soil at the fractions y of the ranges of c, phi, n, k and K.
  Soil at(const std::array<double, 5>& y) const {
    const auto in = [](const Interval& range, double share) {
      return std::lerp(range.low, range.high, share);
    };
    return {.name = name,
            .cohesion_Pa = 1e3 * in(cohesion_kPa, y[0]),
            .friction_angle_rad = kDegree * in(friction_deg, y[1]),
            .sinkage_exponent = in({0.5, 1.2}, y[2]),
            .cohesive_modulus = 0.0,
            .frictional_modulus = 1e6 * in(modulus_MN, y[3]),
            .shear_modulus_m = in({0.01, 0.03}, y[4])};
  }
  Soil middle() const {
    return at({0.5, 0.5, 0.5, 0.5, 0.5});
  }  ///< returns the soil in the middle of all ranges
};

/// The classes of Table 2.1.
inline constexpr std::array<ThesisSoil, 4> kThesisSoils{
    {{"sand", {0.0, 1.0}, {30.0, 35.0}, {1.5, 2.0}},
     {"clay", {5.0, 7.0}, {20.0, 25.0}, {1.0, 1.5}},
     {"loam", {2.0, 4.0}, {20.0, 30.0}, {1.5, 2.0}},
     {"firm soil", {0.0, 1.0}, {30.0, 35.0}, {2.5, 3.0}}}};

/// Soil and simulated samples of a wheel on this soil.
struct ThesisRun {
  Soil soil;
  int soil_class = 0;                  ///< index of the soil's class in kThesisSoils
  std::vector<WheelSample> samples;    ///< samples with reading errors
  std::vector<WheelSample> truth;      ///< samples without reading errors
  std::vector<double> pull_over_load;  ///< true drawbar pull over load DP/W of each sample
};

/// Options of a simulated run.
struct ThesisRunOptions {
  double noise = 0.05;  ///< relative standard deviation of the Gaussian errors of W, T, z and i
  int samples = 10;     ///< number of samples
  Wheel wheel = kThesisWheel;
  double load_scale = 1.0;  ///< factor on the loads of 60 to 100 N
};

/// Generator of simulated runs. A seed gives the same numbers on any machine. Slip varies from 0.2 to 0.8 and
/// back in steps of 0.1; loads are uniform in 60 to 100 N; soil class and parameters are uniform over Table
/// 2.1.
class ThesisRuns {
 public:
  explicit ThesisRuns(std::uint64_t seed) : random_(seed) {}

  /// Returns the next run.
  ThesisRun next(const ThesisRunOptions& options = {}) {
    ThesisRun run;
    run.soil_class = static_cast<int>(random_() % kThesisSoils.size());
    std::array<double, 5> y{};
    for (double& value : y) value = even();
    run.soil = kThesisSoils[static_cast<std::size_t>(run.soil_class)].at(y);
    const auto noisy = [&](double value) { return value * (1.0 + options.noise * normalQuantile(even())); };
    for (int k = 0; k < options.samples; ++k) {
      const double slip = 0.2 + 0.1 * (6 - std::abs(k % 12 - 6));
      const double load = options.load_scale * (60.0 + 40.0 * even());
      const WheelForces f = equilibrium(run.soil, options.wheel, {.load_N = load, .slip = slip});
      const WheelSample truth{load, f.torque_Nm, f.sinkage_m, slip};
      run.truth.push_back(truth);
      run.pull_over_load.push_back(f.drawbar_pull_N / load);
      run.samples.push_back({noisy(load), noisy(f.torque_Nm), noisy(f.sinkage_m), noisy(slip)});
    }
    return run;
  }

 private:
  // Uniform in (0, 1) from the top 53 bits, never 0. Distributions of the standard library differ between
  // implementations.
  double even() { return (static_cast<double>(random_() >> 11U) + 0.5) * 0x1p-53; }

  std::mt19937_64 random_;
};

}  // namespace talus::terramech
