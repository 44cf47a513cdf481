#pragma once

#include <cmath>
#include <cstdint>

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

}  // namespace talus::maps
