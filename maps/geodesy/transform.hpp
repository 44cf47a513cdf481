#pragma once

#include <memory>

#include <talus/maps/geodesy/ellipsoid.hpp>
#include <talus/maps/geodesy/projection.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// A projection on an ellipsoid. Longitudes are relative to the central meridian; Georeference adds the false
/// origin. Immutable.
class Transform {
 public:
  Transform() = default;
  Transform(const Transform&) = delete;
  Transform& operator=(const Transform&) = delete;
  virtual ~Transform() = default;

  virtual Point forward(GeoPoint place) const = 0;
  virtual GeoPoint reverse(Point point) const = 0;
};

/// The transform of a projection method; null for Foreign. The parameters must have been validated.
std::unique_ptr<const Transform> makeTransform(const Ellipsoid& ellipsoid, const Projection& projection);

}  // namespace talus::maps
