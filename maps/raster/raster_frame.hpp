#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <talus/maps/maps.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>

class OGRSpatialReference;

namespace talus::maps {

/// Target of resampling a raster: square cells of 32-bit floats; NaN marks cells without data.
struct WarpTarget {
  /// WKT of the coordinate reference system (CRS) of the result; empty: the CRS of the source.
  std::string wkt{};
  /// Side length of a cell in units of the target CRS; 0: GDAL chooses the size from the source.
  double resolution = 0.0;
  std::optional<Grid> grid{};    ///< exact grid of the result, instead of `resolution`
  std::string method = "cubic";  ///< GDAL's resampling method: near, bilinear, cubic, average
};

/// Returns the resampled raster as a virtual raster, which is computed on reading. NaN means no data in
/// floating-point bands that declare no value for it. `where` names the file in error messages. @throws InputError
Dataset warp(GDALDataset& source, const WarpTarget& target, const std::string& where);

/// Square cells in metres that a raster file has, or to which it is resampled.
struct FramedRaster {
  Grid grid{};           ///< grid of the whole raster in map coordinates
  bool north_up = true;  ///< true if the first row is the northernmost row
  std::optional<Georeference> georeference{};
  std::string resampling{};  ///< method of WarpTarget; empty: the pixels of the file are the cells
};

/// Returns the frame of a file: its own pixels if they are square cells in metres of the stated resolution,
/// else cells of a projection to which its heights must be resampled. Decisions are appended to `notes`. `path`
/// names the file in error messages. @throws InputError, also if ReadOptions::resolution_m contradicts the
/// pixel size of a file without a CRS
FramedRaster frame(GDALDataset& file, const ReadOptions& options, const std::string& path,
                   std::vector<std::string>& notes);

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
