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

  /// Returns the height of the rock above the ground [m] at a distance [m] from its centre.
  double height_m(double distance_m) const;
};

/// Returns the decay rate q [1/m] of the rock size distribution for a rock abundance k = total_share [-], the
/// fraction of the area covered by rocks: q(k) = 1.79 + 0.152 / k [golombek_rapp_1997].
double rockDecay_per_m(double total_share);

/// Parameters of a random rock population.
struct RockOptions {
  std::uint64_t seed = 0;
  /// Diameter of the smallest generated rocks; smaller rocks are represented by the abundance alone.
  double least_diameter_m = 0.5;
  /// Diameter of the largest generated rocks.
  double greatest_diameter_m = 4.0;
};

/// Returns random rocks over a grid with the size-frequency distribution F(D) = k exp(-q(k) D)
/// [golombek_rapp_1997]. F is the fraction of the area covered by rocks with a diameter above D [m];
/// abundance(point) returns the rock abundance k [-].
std::vector<Rock> rockField(const Grid& grid, const std::function<double(Point)>& abundance,
                            const RockOptions& options);

}  // namespace talus::maps
