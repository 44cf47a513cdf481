#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// A half-buried boulder: the upper half of a sphere.
struct Rock {
  Point centre;
  double radius_m = 0.0;

  /// Height over the ground [m] at a distance [m] from its centre.
  double height_m(double distance_m) const;
};

/// Rate at which the share of ground under rocks falls with their diameter [1/m]: q(k) = 1.79 + 0.152 / k
/// [golombek_rapp_1997], for the total share k [-].
double rockDecay_per_m(double total_share);

/// Numbers of a rock population.
struct RockOptions {
  std::uint64_t seed = 0;
  double least_diameter_m = 0.5;  ///< smaller ones are left to the abundance
  double greatest_diameter_m = 4.0;
};

/// Rocks of the exponential size-frequency law F(D) = k exp(-q(k) D) [golombek_rapp_1997], F the share of
/// ground under rocks larger than D, with k [-] as it is at each place of the grid.
std::vector<Rock> rockField(const Grid& grid, const std::function<double(Point)>& abundance,
                            const RockOptions& options);

}  // namespace talus::maps
