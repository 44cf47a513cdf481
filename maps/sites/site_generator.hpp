#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/maps/maps.hpp>

namespace talus::maps {

/// Returns a pseudo-random 64-bit hash of a number: one step of SplitMix64.
constexpr std::uint64_t mixed(std::uint64_t x) noexcept {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// Sequence of uniform random numbers in [0, 1), made from a seed by mixed() of a counter. Each generator of
/// a site uses a separate sequence.
class RandomSequence {
 public:
  explicit RandomSequence(std::uint64_t seed) noexcept : state_(seed) {}

  /// Returns the next number of the sequence.
  double operator()() noexcept { return static_cast<double>(mixed(state_++) >> 11) * 0x1.0p-53; }

 private:
  std::uint64_t state_;
};

/// Gradient noise: a smooth random function of the plane with wavelength 1. Random gradients at integer
/// points are interpolated by fifth-order polynomials. Values lie mostly in [-1, 1] and always within
/// +-sqrt(2). The value at a point is computed independently of other points.
class GradientNoise {
 public:
  explicit GradientNoise(std::uint64_t seed) noexcept : seed_(mixed(seed)) {}

  /// Returns the noise [-] at a point with the coordinates x, y [wavelengths].
  double operator()(double x, double y) const noexcept {
    const double column = std::floor(x);
    const double row = std::floor(y);
    const double u = x - column;
    const double v = y - row;
    const double a = corner(column, row, u, v);
    const double b = corner(column + 1, row, u - 1, v);
    const double c = corner(column, row + 1, u, v - 1);
    const double d = corner(column + 1, row + 1, u - 1, v - 1);
    const double s = smooth(u);
    return 1.4142135623730951 * (a + (b - a) * s + (c - a + (a - b - c + d) * s) * smooth(v));
  }

 private:
  static double smooth(double t) noexcept { return t * t * t * (t * (t * 6 - 15) + 10); }

  double corner(double column, double row, double u, double v) const noexcept {
    const auto key = static_cast<std::uint64_t>(static_cast<std::int64_t>(column)) * 0x8CB92BA72F3D8DD7ULL ^
                     static_cast<std::uint64_t>(static_cast<std::int64_t>(row));
    const std::uint64_t word = mixed(seed_ ^ key);
    const double gx = static_cast<double>(static_cast<std::int32_t>(word)) * 0x1.0p-31;
    const double gy = static_cast<double>(static_cast<std::int32_t>(word >> 32)) * 0x1.0p-31;
    return gx * u + gy * v;
  }

  std::uint64_t seed_;
};

/// Self-affine random terrain: the sum of octaves of gradient noise, from the longest to the shortest
/// wavelength. The amplitude of an octave is proportional to wavelength^hurst.
class FractalGround {
 public:
  struct Options {
    std::uint64_t seed = 0;
    /// Longest wavelength.
    double longest_m = 100.0;
    /// Lower bound of the wavelengths; each octave has half the wavelength of the previous one.
    double shortest_m = 1.0;
    double amplitude_m = 1.0;  ///< amplitude at the longest wavelength
    double hurst = 0.8;        ///< Hurst exponent, 0 to 1; a greater exponent gives smoother terrain [-]
  };

  explicit FractalGround(const Options& options) noexcept
      : options_(options), noise_(options.seed), fall_(std::pow(2.0, -options.hurst)) {}

  /// Returns the height [m] at a point in map coordinates.
  double operator()(double x_m, double y_m) const noexcept {
    // Each octave is rotated by 36.9 degrees relative to the previous one, which hides the square lattice of
    // the noise.
    double height = 0;
    double x = x_m / options_.longest_m;
    double y = y_m / options_.longest_m;
    double amplitude = options_.amplitude_m;
    for (double wavelength = options_.longest_m; wavelength >= options_.shortest_m; wavelength /= 2) {
      height += amplitude * noise_(x, y);
      amplitude *= fall_;
      const double east = 2 * (0.8 * x - 0.6 * y) + 17.31;
      y = 2 * (0.6 * x + 0.8 * y) - 9.17;
      x = east;
    }
    return height;
  }

 private:
  Options options_;
  GradientNoise noise_;
  double fall_;  // ratio of the amplitudes of consecutive octaves
};

/// Kinds of generated terrain.
enum class SiteKind {
  Craters,  ///< lunar terrain: craters with a power-law size distribution, fresh to degraded, on regolith
  Dunes,    ///< Martian terrain: transverse dunes with slip faces at the angle of repose, over bedrock
  Rocks,    ///< Martian plain: rocks with an exponential size-frequency distribution on rolling duricrust
};

/// Kind, size and seed of a generated site.
struct SiteOptions {
  SiteKind kind = SiteKind::Craters;
  int width = 512;            ///< number of columns, 8 to 20000
  int height = 512;           ///< number of rows, 8 to 20000
  double resolution_m = 1.0;  ///< side length of a cell, 0.01 to 1000
  /// Seed of all random numbers. Equal seeds give bit-identical sites on any machine and for any number of
  /// threads.
  std::uint64_t seed = 1;
  /// Number of threads, >= 1.
  int threads = 1;
};

/// Terrain classes of generated sites, by increasing weakness of the soil; Rock marks cells of bedrock or
/// rocks.
enum class SiteClass : std::uint8_t { Firm = 1, Loose = 2, VeryLoose = 3, Rock = 4 };

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

/// Parameters of transverse dunes, i.e. parallel crests across the wind.
struct DuneOptions {
  std::uint64_t seed = 0;
  double wavelength_m = 60.0;  ///< distance between crests
  double height_m = 4.0;       ///< greatest crest height above the dune foot
  /// Angle of repose of the slip faces (lee slopes); the default is 33 degrees, for dry sand.
  double repose_rad = 0.5760;
  double wind_rad = 0.3;  ///< direction towards which the wind blows, counter-clockwise from east
};

/// Sand cover at a point of a dune field.
struct Sand {
  double height_m = 0.0;   ///< height of the sand surface above the underlying ground; 0 between dunes
  bool slip_face = false;  ///< true if the point lies on a lee slope at the angle of repose
};

/// A field of transverse dunes with a gentle windward slope, a crest, and a slip face at the angle of repose.
/// Crests undulate, and end where the sand supply is low. Each point is computed independently of other
/// points.
class DuneField {
 public:
  explicit DuneField(const DuneOptions& options);

  /// Returns the sand cover at a point in map coordinates [m].
  Sand at(double x_m, double y_m) const;

 private:
  DuneOptions options_;
  GradientNoise bend_;
  GradientNoise supply_;
};

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

/// Elevation, soil class and rock abundance at a point of a generated site, before rocks are added.
struct Ground {
  double height_m = 0.0;
  SiteClass soil = SiteClass::Firm;
  double rock_share = 0.0;  ///< rock abundance: fraction of the area covered by rocks [-]
};

/// Interface of the terrain of a generated site without rocks. Each point is computed independently of other
/// points. Immutable.
class Landscape {
 public:
  Landscape() = default;
  Landscape(const Landscape&) = delete;
  Landscape& operator=(const Landscape&) = delete;
  virtual ~Landscape() = default;

  /// Returns the ground at a point in map coordinates [m].
  virtual Ground at(Point p) const = 0;
};

/// Returns the landscape of a site of the kind options.kind on this grid. @throws std::invalid_argument for
/// an unknown kind
std::unique_ptr<const Landscape> makeLandscape(const Grid& grid, const SiteOptions& options);

/// A generated site: synthetic terrain for tests and simulations. All layers have the same grid.
struct Site {
  ElevationMap map;
  Raster<std::uint8_t> classes;  ///< terrain class of each cell, a number of SiteClass
  Raster<float> rock_abundance;  ///< fraction of the area covered by rocks [-]
};

/// Returns a site generated from `options`. After a stop request through `watch`, the returned site has an
/// empty map. @throws std::invalid_argument for an option out of range
Site generateSite(const SiteOptions& options, const ProgressMonitor& watch = {});

}  // namespace talus::maps
