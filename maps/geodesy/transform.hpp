#pragma once

#include <memory>

#include <talus/maps/geodesy/georeference.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

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

}  // namespace talus::maps
