#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/estimate/soil_mixture.hpp>

/// The thesis' simulations (its section 2.3): soils out of Table 2.1 and a wheel driven over them in its slip
/// pattern.
namespace talus::terramech {

/// Its wheel: radius and width 0.1 m.
inline constexpr Wheel kThesisWheel{.radius_m = 0.1, .width_m = 0.1};

/// A soil, and what a wheel read on it.
struct ThesisRun {
  ContactSoil soil;
  int soil_class = 0;                  ///< index into thesisSoils()
  std::vector<WheelSample> samples;    ///< with errors
  std::vector<WheelSample> truth;      ///< without
  std::vector<double> pull_over_load;  ///< true DP/W of each
};

/// How a run is made.
struct ThesisRunOptions {
  double noise = 0.05;  ///< relative Gaussian error of each reading of W, T, z and i
  int samples = 10;
  Wheel wheel = kThesisWheel;
  double load_scale = 1.0;  ///< of the loads of 60 to 100 N
};

/// Runs from a seed: the same numbers on any machine. Slip goes 0.2 to 0.8 and back in steps of 0.1; loads
/// are even between 60 and 100 N; class and parameters are even over Table 2.1.
class ThesisRuns {
 public:
  explicit ThesisRuns(std::uint64_t seed) : random_(seed) {}

  ThesisRun next(const ThesisRunOptions& options = {});

 private:
  double even();
  double normal();

  std::mt19937_64 random_;
};

/// The soil of a contact as a Soil, all of its modulus in k_phi.
Soil soilOf(const ContactSoil& contact);

}  // namespace talus::terramech
