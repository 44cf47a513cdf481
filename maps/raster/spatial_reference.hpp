#pragma once

#include <span>
#include <string>

#include <talus/maps/geodesy/georeference.hpp>

class OGRSpatialReference;

namespace talus::maps {

/// Converts a projected CRS of GDAL; ProjectionMethod::Foreign for a projection unknown to Georeference.
/// `where` is the location in error messages. @throws InputError if the CRS is not projected or its x axis
/// points west
CoordinateSystem coordinateSystem(const OGRSpatialReference& reference, const std::string& where);

/// Converts a coordinate system to GDAL's form with the axis order x, y (longitude, latitude): from its WKT,
/// else from its parameters.
OGRSpatialReference spatialReference(const CoordinateSystem& system);

/// Makes the georeference of a map that contains the given points. Latitude and longitude refer to WGS 84 on
/// Earth, and to the ellipsoid of the system on other bodies. Uses GeographicLib if it agrees with PROJ
/// within 0.01 m at each point; otherwise uses PROJ and sets ProjectionMethod::Foreign.
Georeference georeferenceAt(CoordinateSystem system, std::span<const Point> points);

/// georeferenceAt() for the corners and the centre of a grid.
Georeference georeferenceOn(const CoordinateSystem& system, const Grid& grid);

/// A local projection around a position: transverse Mercator with scale 1 on the central meridian, or for
/// |latitude| > 80 degrees polar stereographic with scale 1 at the pole (1.008 at latitude 80). Uses WGS 84
/// on Earth, else the ellipsoid of `geographic`.
OGRSpatialReference localProjection(const OGRSpatialReference& geographic, GeoPoint centre);

}  // namespace talus::maps
