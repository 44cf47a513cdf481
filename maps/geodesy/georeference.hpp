#pragma once

#include <memory>
#include <string>

#include <talus/maps/geodesy/ellipsoid.hpp>
#include <talus/maps/geodesy/projection.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// Coordinate reference system of a map file.
struct CoordinateSystem {
  std::string name{};  ///< "WGS 84 / UTM zone 10N"
  Ellipsoid ellipsoid{};
  Projection projection{};
  bool planetocentric = false;  ///< true if latitudes are angles at the centre, not of the surface normal
  std::string wkt{};            ///< WKT of the file, copied into layers derived from it; may be empty
};

class Transform;

/// Converts between map coordinates [m] and latitude and longitude on the ellipsoid of the body (WGS 84 on
/// Earth). Latitudes are planetocentric or geographic as CoordinateSystem::planetocentric states. Uses the
/// projections of GeographicLib [karney2013] (agreement with PROJ: 1 mm), or a given Transform. Immutable,
/// cheap to copy, thread-safe.
class Georeference {
 public:
  /// @throws std::invalid_argument if a parameter is out of range
  explicit Georeference(CoordinateSystem system);

  /// Uses the given transform, for example PROJ's (maps_io). @throws std::invalid_argument if a parameter is
  /// out of range
  Georeference(CoordinateSystem system, std::shared_ptr<const Transform> transform);

  /// True if a transform exists. False for ProjectionMethod::Foreign without a given transform; all
  /// conversions then return NaN.
  bool reachesPlaces() const noexcept { return transform_ != nullptr; }

  const CoordinateSystem& system() const noexcept;

  /// Returns the map coordinates [m] of a latitude and longitude [rad]; NaN outside the range of the
  /// projection.
  Point forward(GeoPoint place) const;

  /// Returns latitude and longitude [rad] of map coordinates [m], longitude in [-pi, pi]; NaN outside the
  /// range of the projection.
  GeoPoint reverse(Point point) const;

  /// Geodesic distance [m] on the ellipsoid between two map points.
  double distance_m(Point from, Point to) const;

  /// Geodesic length per map length [-] along x and along y at a point; 1 where the projection preserves
  /// lengths.
  Point groundScale(Point at) const;

  std::string body() const { return bodyName(system().ellipsoid); }

 private:
  GeoPoint geographic(Point point) const;

  CoordinateSystem system_;
  std::shared_ptr<const Transform> transform_;
};

}  // namespace talus::maps
