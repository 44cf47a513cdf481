#pragma once

#include <cstdint>

#include <talus/maps/sites/value_noise.hpp>

namespace talus::maps {

/// Parameters of transverse dunes.
struct DuneOptions {
  std::uint64_t seed = 0;
  double wavelength_m = 60.0;  ///< crest spacing
  double height_m = 4.0;       ///< greatest crest height above the dune foot
  double repose_rad = 0.5760;  ///< angle of repose of the slip faces: 33 degrees, dry sand
  double wind_rad = 0.3;       ///< direction to which the wind blows, counter-clockwise from east
};

/// Sand cover at a point.
struct Sand {
  double height_m = 0.0;   ///< above the underlying ground; 0 between dunes
  bool slip_face = false;  ///< true if the point lies on a lee slope at the angle of repose
};

/// Transverse dunes with a gentle stoss slope, a crest, and a slip face at the angle of repose. Crests
/// undulate and end where the sand supply is low. Each point is computed independently of its neighbours.
class DuneField {
 public:
  explicit DuneField(const DuneOptions& options);

  Sand at(double x_m, double y_m) const;

 private:
  DuneOptions options_;
  GradientNoise bend_;
  GradientNoise supply_;
};

}  // namespace talus::maps
