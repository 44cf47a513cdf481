#pragma once

#include <cstdint>

#include <talus/maps/sites/value_noise.hpp>

namespace talus::maps {

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

}  // namespace talus::maps
