#pragma once

#include <span>
#include <string>

#include <talus/maps/geodesy/georeference.hpp>

class OGRSpatialReference;

namespace talus::maps {

/// What Talus needs of a projected CRS as GDAL holds it; ProjectionMethod::Foreign where Georeference does not know
/// its projection. `where` opens the error line. @throws InputError when it is not projected or its axes are mirrored
CoordinateSystem coordinateSystem(const OGRSpatialReference& reference, const std::string& where);

/// GDAL's form of a coordinate system, axes in the order x, y (longitude, latitude): from its WKT or else
/// from its numbers.
OGRSpatialReference spatialReference(const CoordinateSystem& system);

/// Places of a coordinate system whose map has these points: longitude and latitude are those of WGS 84 on Earth, of the
/// system's own ellipsoid elsewhere. By GeographicLib where that agrees with PROJ to a centimetre at each of the points,
/// else by PROJ, and the system is then ProjectionMethod::Foreign.
Georeference georeferenceAt(CoordinateSystem system, std::span<const Point> points);

/// The same at the corners and in the middle of a grid.
Georeference georeferenceOn(const CoordinateSystem& system, const Grid& grid);

/// A projection true to a millimetre per ten metres around a place: transverse Mercator, near a pole polar
/// stereographic, on Earth of WGS 84. `geographic` holds the ellipsoid.
OGRSpatialReference localProjection(const OGRSpatialReference& geographic, GeoPoint centre);

}  // namespace talus::maps
