#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// A crater: a paraboloid bowl with a raised rim and an ejecta blanket.
struct Crater {
  Point centre;
  double radius_m = 0.0;
  double age = 0.0;  ///< degradation, 0 (fresh) to 1 (almost eroded) [-]

  /// Returns the height of the crater above the surrounding ground [m] at a distance [m] from its centre; 0
  /// beyond three radii.
  double height_m(double distance_m) const;

  /// Returns the relative thickness of fresh ejecta, 0 to 1 [-], at a distance [m] from the centre: 1 - age
  /// inside the rim, decreasing outwards with the square of the distance, 0 beyond three radii.
  double freshness(double distance_m) const;
};

/// Parameters of a random crater population.
struct CraterOptions {
  std::uint64_t seed = 0;
  /// Diameter of the smallest craters.
  double least_diameter_m = 4.0;
  /// Diameter of the largest craters.
  double greatest_diameter_m = 100.0;
  /// Density c [-] of the population: c A / D^2 craters with a diameter above D [m] lie on an area A [m^2].
  double density = 0.04;
};

/// Returns random craters over a grid and a margin around the grid, in order of decreasing size. The
/// cumulative size-frequency distribution is a power law with exponent -2, like the lunar equilibrium
/// population [trask_1966]. Most craters are degraded: age = cbrt(u), u uniform in [0, 1).
std::vector<Crater> craterField(const Grid& grid, const CraterOptions& options);

/// Spatial index of craters. Each square bin of the map stores the craters that reach into the bin.
/// Immutable.
class CraterBins {
 public:
  CraterBins(const Grid& grid, std::vector<Crater> craters);

  /// Calls visit(crater, distance_m) for each crater that may reach the point `p`, in order of decreasing
  /// size; distance_m [m] is measured from the centre of the crater.
  void forEachNear(Point p, const auto& visit) const {
    for (std::size_t i : bins_[bin(p)]) {
      const Crater& c = craters_[i];
      visit(c, std::hypot(p.x_m - c.centre.x_m, p.y_m - c.centre.y_m));
    }
  }

 private:
  int place(double offset_m, int count) const;
  std::size_t index(int column, int row) const;
  std::size_t bin(Point p) const;
  void enter(std::size_t crater);

  std::vector<Crater> craters_;
  Point south_west_;
  double side_m_ = 0.0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::vector<std::size_t>> bins_;
};

}  // namespace talus::maps
