#pragma once

#include <string>

namespace talus::maps {

/// A place on a body. Its latitude is geographic (of the surface normal) unless a coordinate system says that
/// it is planetocentric; on a sphere these are one.
struct GeoPoint {
  double latitude_rad = 0.0;   ///< -pi/2 to pi/2, north positive
  double longitude_rad = 0.0;  ///< east positive

  friend bool operator==(const GeoPoint&, const GeoPoint&) = default;
};

/// The figure of a body: an ellipsoid of revolution, or a sphere when flattening is 0.
struct Ellipsoid {
  double equatorial_radius_m = 0.0;  ///< > 0
  double flattening = 0.0;           ///< (a - b) / a, 0 <= f < 1

  friend bool operator==(const Ellipsoid&, const Ellipsoid&) = default;
};

inline constexpr Ellipsoid kEarth{6378137.0, 1.0 / 298.257223563};                 ///< WGS 84
inline constexpr Ellipsoid kMoon{1737400.0, 0.0};                                  ///< IAU 2015 sphere
inline constexpr Ellipsoid kMars{3396190.0, (3396190.0 - 3376200.0) / 3396190.0};  ///< IAU 2015

/// "Earth", "Moon", "Mars", ... by the equatorial radius (maps use spheres of a body's local radius too), or
/// "body of radius R km" for one not in the list.
std::string bodyName(const Ellipsoid& ellipsoid);

/// Planetocentric latitude [rad] (angle at the centre) of a geographic one, and back.
double planetocentricLatitude(const Ellipsoid& ellipsoid, double geographic_rad);
double geographicLatitude(const Ellipsoid& ellipsoid, double planetocentric_rad);

}  // namespace talus::maps
