#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// A bowl with a raised rim.
struct Crater {
  Point centre;
  double radius_m = 0.0;
  double age = 0.0;  ///< 0 fresh, 1 almost worn away

  /// Height over the ground around [m] at a distance [m] from the centre; 0 beyond three radii.
  double height_m(double distance_m) const;

  /// How thick the ejecta lie, 0 to 1: 1 on the rim of a fresh crater, 0 beyond three radii.
  double freshness(double distance_m) const;
};

/// Numbers of a crater population.
struct CraterOptions {
  std::uint64_t seed = 0;
  double least_diameter_m = 4.0;
  double greatest_diameter_m = 100.0;
  double density = 0.04;  ///< craters larger than D [m] on an area A [m^2]: density A / D^2
};

/// Craters of a power law of exponent -2, the slope of the lunar equilibrium population [trask_1966], over a
/// grid and a margin around it, large before small; most are worn.
std::vector<Crater> craterField(const Grid& grid, const CraterOptions& options);

/// Craters in square bins, each with those that reach into it, so that a place evaluates few of them.
/// Immutable.
class CraterBins {
 public:
  CraterBins(const Grid& grid, std::vector<Crater> craters);

  /// Calls visit(crater, distance_m) for each crater that may reach the place, large before small.
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
