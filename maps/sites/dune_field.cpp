#include <algorithm>
#include <cmath>
#include <numbers>

#include <talus/maps/sites/dune_field.hpp>

namespace talus::maps {

DuneField::DuneField(const DuneOptions& options)
    : options_(options), bend_(options.seed), supply_(mixed(options.seed)) {}

Sand DuneField::at(double x_m, double y_m) const {
  const double along = x_m * std::cos(options_.wind_rad) + y_m * std::sin(options_.wind_rad);
  const double across = y_m * std::cos(options_.wind_rad) - x_m * std::sin(options_.wind_rad);
  const double w = options_.wavelength_m;
  // The crest line varies across the wind only, so that slip faces keep the angle of repose.
  const double phase =
      along / w + 0.45 * bend_(across / (3.0 * w), 0.5) + 0.15 * bend_(across / (0.9 * w), 7.5);
  const double dune = std::floor(phase);
  // The sand supply varies along the crest, independently for each dune.
  const double supply = 0.45 + 1.2 * supply_(across / (4 * w), 1.7 * dune + 0.5);
  const double crest_m = options_.height_m * std::clamp(supply, 0.0, 1.0);
  if (crest_m <= 0) return {};
  const double lee_m = crest_m / std::tan(options_.repose_rad);
  const double stoss_m = 0.92 * w - lee_m;
  const double s = (phase - dune) * w;
  if (s > stoss_m + lee_m) return {};
  if (s > stoss_m) return {.height_m = crest_m * (stoss_m + lee_m - s) / lee_m, .slip_face = true};
  // Cosine profile of the stoss slope.
  const double t = s / stoss_m;
  return {.height_m = crest_m * (0.5 - 0.5 * std::cos(std::numbers::pi * t)), .slip_face = false};
}

}  // namespace talus::maps
