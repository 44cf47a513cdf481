#pragma once

#include <string>

#include <talus/maps/geodesy/georeference.hpp>

class OGRSpatialReference;

namespace talus::maps {

/// What Talus needs of a projected CRS as GDAL holds it. `where` opens the error line.
/// @throws InputError when it is not projected, its projection is unknown to Georeference or its axes are
/// mirrored
CoordinateSystem coordinateSystem(const OGRSpatialReference& reference, const std::string& where);

/// GDAL's form of a coordinate system, axes in the order x, y (longitude, latitude): from its WKT or else
/// from its numbers.
OGRSpatialReference spatialReference(const CoordinateSystem& system);

/// A projection true to a millimetre per ten metres around a place: transverse Mercator, near a pole polar
/// stereographic. `geographic` holds the ellipsoid.
OGRSpatialReference localProjection(const OGRSpatialReference& geographic, GeoPoint centre);

}  // namespace talus::maps
