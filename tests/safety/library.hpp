#pragma once

#include <map>
#include <string>

#include "wheel.hpp"

namespace safety {

/// A rover as in its YAML file, in SI units.
struct Rover {
  double mass_kg = 0.0;
  double gravity_m_s2 = 9.80665;
  int wheels = 6;
  double wheel_radius_m = 0.1;
  double wheel_width_m = 0.1;
  double wheelbase_m = 1.0;
  double track_m = 1.0;
  double clearance_m = 0.2;
  double centre_of_mass_height_m = 0.3;
  double max_pitch_rad = 0.35;
  double max_roll_rad = 0.35;
  double max_torque_Nm = 1.0;

  double wheelLoad_N() const { return mass_kg * gravity_m_s2 / wheels; }
};

/// A soil with the standard deviations of its file; 0 for a parameter without one.
struct SoilPrior {
  Soil mean;
  Soil deviation{.sinkage_exponent = 0.0,
                 .shear_modulus_m = 0.0,
                 .c1 = 0.0,
                 .c2 = 0.0,
                 .density_kg_m3 = 0.0,
                 .digging_exponent = 0.0,
                 .side_bulldozing = 0.0};
};

/// The library's folder, which contains soils/ and rovers/.
struct Library {
  std::string folder;

  Rover rover(const std::string& name) const;
  SoilPrior soil(const std::string& name) const;
  /// Maps each class number of the raster to a soil, given as a library name or a mapping. Throws
  /// std::runtime_error.
  std::map<int, SoilPrior> classes(const std::string& path) const;
};

}  // namespace safety
