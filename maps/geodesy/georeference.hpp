#pragma once

#include <memory>
#include <string>

#include <talus/maps/grid/grid.hpp>

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

/// Map projections of the elevation maps that rovers use. Map files store the numbers.
enum class ProjectionMethod {
  TransverseMercator = 0,
  Mercator = 1,  ///< `scale` is the scale factor along the parallel standard_parallel_1_rad
  /// PROJ's eqc on a sphere of the equatorial radius; true to scale along standard_parallel_1_rad.
  Equirectangular = 2,
  /// `scale` is the scale factor along standard_parallel_1_rad; the sign of that parallel selects the pole.
  PolarStereographic = 3,
  LambertConformalConic = 5,  ///< uses standard parallels 1 and 2, which are equal for a single parallel
  /// Projection defined by the WKT only: any other projection, or a datum of Earth other than WGS 84.
  Foreign = 12,
};

/// Parameters of a projection; parameters that the method does not use are ignored.
struct Projection {
  ProjectionMethod method = ProjectionMethod::TransverseMercator;
  double latitude_of_origin_rad = 0.0;
  /// Longitude of the central meridian from the body's prime meridian, east positive.
  double central_meridian_rad = 0.0;
  double standard_parallel_1_rad = 0.0;
  double standard_parallel_2_rad = 0.0;
  double scale = 1.0;  ///< scale factor at the origin or the standard parallel, > 0 [-]
  double false_easting_m = 0.0;
  double false_northing_m = 0.0;
};

/// Coordinate reference system (CRS) of a map file.
struct CoordinateSystem {
  std::string name{};  ///< name of the system, e.g. "WGS 84 / UTM zone 10N"
  Ellipsoid ellipsoid{};
  Projection projection{};
  /// True if latitudes are angles at the centre of the body; false if latitudes are angles of the surface
  /// normal.
  bool planetocentric = false;
  /// Well-known text (WKT) of the system in the map file, copied into layers derived from the map; may be
  /// empty.
  std::string wkt{};
};

/// Interface of a map projection on an ellipsoid. Longitudes are relative to the central meridian;
/// Georeference adds the false easting and northing. Immutable.
class Transform {
 public:
  Transform() = default;
  Transform(const Transform&) = delete;
  Transform& operator=(const Transform&) = delete;
  virtual ~Transform() = default;

  /// Returns map coordinates [m] of a latitude and longitude.
  virtual Point forward(GeoPoint place) const = 0;
  /// Returns latitude and longitude of map coordinates [m].
  virtual GeoPoint reverse(Point point) const = 0;
};

/// Returns the transform of a projection method, or null for ProjectionMethod::Foreign. The parameters must
/// have been validated.
std::unique_ptr<const Transform> makeTransform(const Ellipsoid& ellipsoid, const Projection& projection);

/// Converts between map coordinates [m] and latitude and longitude [rad] on the ellipsoid of the body (WGS 84
/// on Earth). CoordinateSystem::planetocentric determines whether latitudes are planetocentric or geographic.
/// The conversion uses the projections of GeographicLib [karney2013] (agreement with PROJ: 1 mm) or a given
/// Transform. Immutable, cheap to copy, thread-safe.
class Georeference {
 public:
  /// Uses the projection of GeographicLib for the system's projection method. @throws std::invalid_argument
  /// if a parameter of the system is out of range
  explicit Georeference(CoordinateSystem system);

  /// Uses the given transform, for example PROJ's (maps_io). @throws std::invalid_argument if a parameter of
  /// the system is out of range
  Georeference(CoordinateSystem system, std::shared_ptr<const Transform> transform);

  /// Returns true if conversions are possible. Returns false for ProjectionMethod::Foreign without a given
  /// transform; all conversions then return NaN.
  bool reachesPlaces() const noexcept { return transform_ != nullptr; }

  const CoordinateSystem& system() const noexcept;

  /// Returns the map coordinates [m] of a latitude and longitude [rad]; NaN outside the range of the
  /// projection.
  Point forward(GeoPoint place) const;

  /// Returns the latitude and longitude [rad] of map coordinates [m], with longitude in [-pi, pi]; NaN
  /// outside the range of the projection.
  GeoPoint reverse(Point point) const;

  /// Returns the geodesic distance [m] on the ellipsoid between two points in map coordinates.
  double distance_m(Point from, Point to) const;

  /// Returns the geodesic length per map length [-] at a point, along x and along y. The value is 1 where the
  /// projection preserves lengths.
  Point groundScale(Point at) const;

  /// Returns the name of the body, e.g. "Mars" (bodyName()).
  std::string body() const { return bodyName(system().ellipsoid); }

 private:
  GeoPoint geographic(Point point) const;

  CoordinateSystem system_;
  std::shared_ptr<const Transform> transform_;
};

}  // namespace talus::maps
