#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/estimate/soil_mixture.hpp>

/// Simulated telemetry of the thesis (section 2.3): soils drawn from Table 2.1, and a wheel driven over them
/// with the slip pattern of the thesis.
namespace talus::terramech {

/// Wheel of the thesis: radius and width 0.1 m.
inline constexpr Wheel kThesisWheel{.radius_m = 0.1, .width_m = 0.1};

/// Soil and simulated samples of a wheel on this soil.
struct ThesisRun {
  ContactSoil soil;
  int soil_class = 0;                  ///< index of the soil's class in thesisSoils()
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
  ThesisRun next(const ThesisRunOptions& options = {});

 private:
  double even();
  double normal();

  std::mt19937_64 random_;
};

/// Returns the Soil with the parameters of a ContactSoil: k_c = 0, k_phi = k.
Soil soilOf(const ContactSoil& contact);

}  // namespace talus::terramech
