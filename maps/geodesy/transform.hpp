#pragma once

#include <memory>

#include <talus/maps/geodesy/ellipsoid.hpp>
#include <talus/maps/geodesy/projection.hpp>
#include <talus/maps/grid/grid.hpp>

namespace talus::maps {

/// One projection on one ellipsoid; longitudes are counted from the central meridian and the false origin is
/// left to Georeference. Immutable.
class Transform {
 public:
  Transform() = default;
  Transform(const Transform&) = delete;
  Transform& operator=(const Transform&) = delete;
  virtual ~Transform() = default;

  virtual Point forward(GeoPoint place) const = 0;
  virtual GeoPoint reverse(Point point) const = 0;
};

/// The transform of a method, null for Foreign; parameters are taken as checked.
std::unique_ptr<const Transform> makeTransform(const Ellipsoid& ellipsoid, const Projection& projection);

}  // namespace talus::maps
