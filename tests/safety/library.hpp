#pragma once

#include <map>
#include <string>

#include "wheel.hpp"

namespace safety {

/// A rover as its YAML file has it, in SI units.
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

/// A soil with the standard deviations that its file states; 0 where it states none.
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

/// Folder with soils/ and rovers/ of the library.
struct Library {
  std::string folder;

  Rover rover(const std::string& name) const;
  SoilPrior soil(const std::string& name) const;
  /// Class number of the raster to soil: names of the library or mappings. Throws std::runtime_error.
  std::map<int, SoilPrior> classes(const std::string& path) const;
};

}  // namespace safety
