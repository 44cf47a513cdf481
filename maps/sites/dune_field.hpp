#pragma once

#include <cstdint>

#include <talus/maps/sites/value_noise.hpp>

namespace talus::maps {

/// Shape of transverse dunes.
struct DuneOptions {
  std::uint64_t seed = 0;
  double wavelength_m = 60.0;  ///< from crest to crest
  double height_m = 4.0;       ///< of the tallest crest over its foot
  double repose_rad = 0.5760;  ///< angle of the slip faces: 33 degrees, dry sand
  double wind_rad = 0.3;       ///< direction the wind blows to, counter-clockwise from east
};

/// Sand at a place.
struct Sand {
  double height_m = 0.0;   ///< over the ground below; 0 between the dunes
  bool slip_face = false;  ///< on a lee side at the angle of repose
};

/// Transverse dunes: a gentle stoss side, a crest, and a slip face at the angle of repose; crests wave and
/// die out where sand is scarce. Known at any place without its neighbours.
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
