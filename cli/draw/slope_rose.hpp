#pragma once

#include <optional>
#include <string>
#include <vector>

#include <talus/cli/draw/canvas.hpp>

namespace talus::cli {

/// Driving properties of a cell in one heading.
struct RoseHeading {
  double heading_rad = 0.0;  ///< heading, counter-clockwise from east
  double cost_J_per_m = 0.0;
  double slip = 0.0;
  double slip_angle_rad = 0.0;  ///< NaN: unknown
  bool refused = false;         ///< true if the heading is refused; it then has no values in the chart
};

/// Three polar charts over the heading (east to the right, north up): magnitudes of cost, slip and slip
/// angle. Sectors of refused headings are shaded. On sloping ground, an arrow points uphill.
struct SlopeRose {
  std::string title;
  /// Headings at equal spacing; the first heading is not repeated at the end.
  std::vector<RoseHeading> headings;
  std::optional<double> uphill_rad;
};

/// Returns the drawn charts as the bytes of a PNG or SVG file.
std::string draw(const SlopeRose& rose, Canvas::Kind kind);

}  // namespace talus::cli
