#pragma once

#include <cstdio>
#include <string>

#include <talus/terramech/contact/wheel_on_soil.hpp>

#include "temporary_file.hpp"

namespace talus::terramech {

inline const Soil kMadeSoil{.name = "made",
                            .cohesion_Pa = 1500.0,
                            .friction_angle_rad = 0.45,
                            .sinkage_exponent = 1.0,
                            .cohesive_modulus = 0.0,
                            .frictional_modulus = 8e5,
                            .shear_modulus_m = 0.015};

inline constexpr Wheel kMadeWheel{.radius_m = 0.15, .width_m = 0.15};

/// Load and slip of row number k, from 0.
inline WheelOperation madeOperation(int k) {
  return {.load_N = 120.0 + 30.0 * (k % 3), .slip = 0.15 + 0.06 * k};
}

/// A row of a table, with all digits, so that reading returns the same bits.
inline std::string wheelLine(const WheelSample& s, const Wheel& wheel) {
  char text[200];
  std::snprintf(text, sizeof text, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", s.load_N, s.torque_Nm, s.sinkage_m,
                s.slip, wheel.radius_m, wheel.width_m);
  return text;
}

inline const std::string kWheelHead = "load_N,torque_Nm,sinkage_m,slip,wheel_radius_m,wheel_width_m";

/// Twelve exact rows of a wheel on the synthetic soil.
inline std::string madeRows() {
  std::string text = kWheelHead + "\n";
  for (int k = 0; k < 12; ++k) {
    const WheelOperation at = madeOperation(k);
    const WheelForces f = equilibrium(kMadeSoil, kMadeWheel, at);
    text += wheelLine({at.load_N, f.torque_Nm, f.sinkage_m, at.slip}, kMadeWheel) + "\n";
  }
  return text;
}

/// The rows of madeRows() as a file.
class WheelTable : public test::TemporaryFile {
 public:
  WheelTable() : TemporaryFile(madeRows()) {}
};

/// The synthetic soil as a model file.
inline const std::string kMadeSoilText =
    "soil: {name: made, cohesion_Pa: 1500, friction_angle_rad: 0.45, sinkage_exponent: 1.0, "
    "cohesive_modulus: 0, "
    "frictional_modulus: 8.0e5, shear_modulus_m: 0.015}\n";

}  // namespace talus::terramech
