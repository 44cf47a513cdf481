#pragma once

#include <memory>
#include <string>

#include <talus/maps/geodesy/ellipsoid.hpp>
#include <talus/maps/geodesy/projection.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

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

class Transform;

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
