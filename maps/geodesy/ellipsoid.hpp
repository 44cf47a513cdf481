#pragma once

#include <string>

namespace talus::maps {

/// A latitude and longitude on a body. The latitude is geographic (angle of the surface normal to the
/// equatorial plane) unless the coordinate system is planetocentric (angle at the centre of the body). On a
/// sphere both latitudes are equal.
struct GeoPoint {
  double latitude_rad = 0.0;   ///< latitude, -pi/2 to pi/2, north positive
  double longitude_rad = 0.0;  ///< longitude, east positive

  friend bool operator==(const GeoPoint&, const GeoPoint&) = default;
};

/// Figure of a body: an ellipsoid of revolution, or a sphere if flattening = 0.
struct Ellipsoid {
  double equatorial_radius_m = 0.0;  ///< equatorial radius a, > 0
  double flattening = 0.0;           ///< flattening f = (a - b) / a with the polar radius b, 0 <= f < 1 [-]

  friend bool operator==(const Ellipsoid&, const Ellipsoid&) = default;
};

inline constexpr Ellipsoid kEarth{6378137.0, 1.0 / 298.257223563};                 ///< WGS 84
inline constexpr Ellipsoid kMoon{1737400.0, 0.0};                                  ///< IAU 2015 sphere
inline constexpr Ellipsoid kMars{3396190.0, (3396190.0 - 3376200.0) / 3396190.0};  ///< IAU 2015

/// Returns the name of the body with this equatorial radius ("Earth", "Moon", "Mars", ...), or "body of
/// radius R km" for an unknown radius. A local radius of a body is recognised, too, because maps may use a
/// sphere of local radius.
std::string bodyName(const Ellipsoid& ellipsoid);

/// Returns the planetocentric latitude [rad] of a geographic latitude [rad] on an ellipsoid with equatorial
/// radius a and polar radius b: tan(planetocentric) = (b / a)^2 tan(geographic). geographicLatitude() is the
/// inverse.
double planetocentricLatitude(const Ellipsoid& ellipsoid, double geographic_rad);
double geographicLatitude(const Ellipsoid& ellipsoid, double planetocentric_rad);

}  // namespace talus::maps
