#pragma once

#include <optional>
#include <string>
#include <vector>

#include <talus/cli/draw/canvas.hpp>

namespace talus::cli {

/// What driving a cell is like in one heading.
struct RoseHeading {
  double heading_rad = 0.0;  ///< counter-clockwise from east
  double cost_J_per_m = 0.0;
  double slip = 0.0;
  double slip_angle_rad = 0.0;  ///< NaN where it is not known
  bool refused = false;         ///< the numbers are then not drawn
};

/// Three polar charts over the headings, east to the right and north up: cost, slip, slip angle, as magnitudes;
/// sectors whose heading is refused are shaded, and an arrow points uphill where there is an uphill.
struct SlopeRose {
  std::string title;
  std::vector<RoseHeading> headings;  ///< evenly spaced, the first again not at the end
  std::optional<double> uphill_rad;
};

/// The bytes of a PNG or SVG file.
std::string draw(const SlopeRose& rose, Canvas::Kind kind);

}  // namespace talus::cli
