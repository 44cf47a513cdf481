#pragma once

#include <string>
#include <vector>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>

namespace talus::cli {

/// One wheel and its operating point.
struct WheelOperatingPoint {
  terramech::Soil soil;
  terramech::Rover rover;
  double load_N = 0.0;
  double slip = 0.0;
  double slip_angle_rad = 0.0;
  std::vector<terramech::Soil> others{};  ///< soils compared with `soil` over slip
};

/// A self-contained HTML page: forces of the wheel, stresses along the rim (thesis Fig. C.4), and drawbar
/// pull, torque and sinkage over slip (Figs. 3.8, D.3). Throws as terramech::equilibrium().
std::string wheelReport(const WheelOperatingPoint& work);

}  // namespace talus::cli
