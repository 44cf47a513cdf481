#pragma once

#include <memory>
#include <string>

#include <talus/maps/geodesy/ellipsoid.hpp>
#include <talus/maps/geodesy/projection.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// What a file says of its coordinates.
struct CoordinateSystem {
  std::string name{};  ///< "WGS 84 / UTM zone 10N"
  Ellipsoid ellipsoid{};
  Projection projection{};
  bool planetocentric =
      false;          ///< latitudes are angles at the centre of the ellipsoid, not of its surface normal
  std::string wkt{};  ///< the file's own words, written back into the layers made from it; may be empty
};

class Transform;

/// Carries places between map metres and latitude, longitude on the body's own ellipsoid (WGS 84 on Earth), the
/// latitude of the kind that the coordinate system has (planetocentric or geographic; the same on a sphere).
/// Through GeographicLib [karney2013] where it has the projection, which agrees with PROJ to a millimetre, or a
/// transform that is handed in. Immutable, cheap to copy, safe to share between threads.
class Georeference {
 public:
  /// @throws std::invalid_argument when a parameter is out of its range
  explicit Georeference(CoordinateSystem system);

  /// The same by a transform from elsewhere, such as PROJ's (maps_io).
  Georeference(CoordinateSystem system, std::shared_ptr<const Transform> transform);

  /// Whether places are known: not for ProjectionMethod::Foreign without a transform. All that follows is NaN then.
  bool reachesPlaces() const noexcept { return transform_ != nullptr; }

  const CoordinateSystem& system() const noexcept;

  /// Map metres of a place; NaN where the projection does not reach.
  Point forward(GeoPoint place) const;

  /// Place of map metres, longitude in [-pi, pi]; NaN outside the projection's range.
  GeoPoint reverse(Point point) const;

  /// Length [m] of the shortest way on the ellipsoid between two points of the map.
  double distance_m(Point from, Point to) const;

  /// Ground metres per map metre eastward and northward at a point (1 where the map is true).
  Point groundScale(Point at) const;

  std::string body() const { return bodyName(system().ellipsoid); }

 private:
  GeoPoint geographic(Point point) const;

  CoordinateSystem system_;
  std::shared_ptr<const Transform> transform_;
};

}  // namespace talus::maps
