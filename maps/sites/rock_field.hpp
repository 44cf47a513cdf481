#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// A half-buried rock: the upper half of a sphere.
struct Rock {
  Point centre;
  double radius_m = 0.0;

  /// Height above the ground [m] at a distance [m] from the centre.
  double height_m(double distance_m) const;
};

/// Decay rate q of the rock-covered area with diameter [1/m]: q(k) = 1.79 + 0.152 / k [golombek_rapp_1997],
/// for the rock abundance k [-].
double rockDecay_per_m(double total_share);

/// Parameters of a rock population.
struct RockOptions {
  std::uint64_t seed = 0;
  double least_diameter_m = 0.5;  ///< smaller rocks are represented by the abundance alone
  double greatest_diameter_m = 4.0;
};

/// Random rocks with the exponential size-frequency distribution F(D) = k exp(-q(k) D) [golombek_rapp_1997]:
/// F is the fraction of the area covered by rocks with a diameter above D, and k [-] the rock abundance at a
/// point of the grid.
std::vector<Rock> rockField(const Grid& grid, const std::function<double(Point)>& abundance,
                            const RockOptions& options);

}  // namespace talus::maps
