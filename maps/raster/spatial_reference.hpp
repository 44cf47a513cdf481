#pragma once

#include <span>
#include <string>

#include <talus/maps/geodesy/georeference.hpp>

class OGRSpatialReference;

namespace talus::maps {

/// Returns the CoordinateSystem of a projected coordinate reference system (CRS) of GDAL. The method is
/// ProjectionMethod::Foreign for a projection that Georeference does not implement. `where` names the file in
/// error messages. @throws InputError if the CRS is not projected or its x axis points west
CoordinateSystem coordinateSystem(const OGRSpatialReference& reference, const std::string& where);

/// Returns GDAL's form of a coordinate system, from its WKT if present, or from its parameters. The axis
/// order is x, y (longitude, latitude).
OGRSpatialReference spatialReference(const CoordinateSystem& system);

/// Returns the georeference of a map that contains the given points. Latitude and longitude refer to WGS 84
/// on Earth, and to the ellipsoid of the system on other bodies. Uses the projection of GeographicLib if it
/// agrees with PROJ within 0.01 m at each point; otherwise uses PROJ and sets ProjectionMethod::Foreign.
Georeference georeferenceAt(CoordinateSystem system, std::span<const Point> points);

/// Returns georeferenceAt() for the corners and the centre of a grid.
Georeference georeferenceOn(const CoordinateSystem& system, const Grid& grid);

/// Returns a local projection around a position: transverse Mercator with scale 1 on the central meridian or,
/// for |latitude| > 80 degrees, polar stereographic with scale 1 at the pole (1.008 at latitude 80). Uses WGS
/// 84 on Earth, and the ellipsoid of `geographic` on other bodies.
OGRSpatialReference localProjection(const OGRSpatialReference& geographic, GeoPoint centre);

}  // namespace talus::maps
