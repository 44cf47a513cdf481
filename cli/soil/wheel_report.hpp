#pragma once

#include <string>
#include <vector>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>

namespace talus::cli {

/// A wheel and its operating point: soil, load, slip and slip angle.
struct WheelOperatingPoint {
  terramech::Soil soil;
  terramech::Rover rover;
  double load_N = 0.0;
  double slip = 0.0;
  double slip_angle_rad = 0.0;
  std::vector<terramech::Soil> others{};  ///< further soils that are compared with `soil` over slip
};

/// Returns a self-contained HTML page: forces of the wheel, stresses along the rim (thesis Fig. C.4), and
/// drawbar pull, torque and sinkage over slip (Figs. 3.8, D.3). Throws the errors of
/// terramech::equilibrium().
std::string wheelReport(const WheelOperatingPoint& work);

}  // namespace talus::cli
