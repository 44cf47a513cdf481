#pragma once

/// Umbrella header of talus::maps_io: includes readers of elevation, layers and positions from files, and the
/// writer of GeoTIFF files.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <talus/maps/maps.hpp>

namespace talus {
class OutputFile;
}

namespace talus::maps {

/// Options for reading a raster file.
struct ReadOptions {
  /// Band number from 1; unset: the band whose description names elevation, or otherwise the first band.
  std::optional<int> band{};
  /// Side length of a cell. Required for a file without a coordinate reference system (CRS); for other files,
  /// a value causes resampling.
  std::optional<double> resolution_m{};
  std::optional<Window> window{};  ///< part of the file to read, in map coordinates or degrees
  std::optional<double> nodata{};  ///< value of cells without data; overrides the value that the file states
  /// True if single cells without data stay without data. False: such a cell whose neighbours agree is
  /// interpolated (readElevation()).
  bool keep_holes = false;
  /// Factor on the heights, applied after the conversion from the unit that the file states [-]. Where the file
  /// states a unit that is not known, metres per unit.
  std::optional<double> vertical_scale{};
  bool ignore_crs = false;  ///< true if the CRS of the file is ignored and coordinates are local metres
  /// True if a virtual raster (VRT) is accepted whose source files lie in its own folder.
  bool allow_vrt = false;
  /// Number of cells per side, >= 1, whose mean becomes one cell. Overviews (coarser copies) of a file are not
  /// read.
  int overview = 1;
  bool frame_only = false;  ///< true: grid and georeference alone; the elevations are not read, and are 0
  /// Maximum number of cells; larger maps are rejected (the default takes 1.6 GB as float).
  std::uint64_t max_cells = 400'000'000;
};

/// Returns the elevation map of a file: any raster that GDAL opens. Rasters in degrees, and
/// rasters with rotated or non-square pixels, are resampled to square cells in metres; ElevationMap::notes
/// record the resampling. A cell without data is interpolated if at least three pairs of opposite neighbours
/// are known and their means agree within a quarter of the cell's side (ours), unless ReadOptions::keep_holes.
/// @throws InputError with file, reason and remedy
ElevationMap readElevation(const std::string& path, const ReadOptions& options = {});

/// Returns the grid of the map that readElevation() would return, without reading the elevations. @throws
/// InputError, also if the grid exceeds ReadOptions::max_cells
Grid elevationGrid(const std::string& path, const ReadOptions& options = {});

/// One band of a GeoTIFF file.
struct Layer {
  std::string name{};      ///< band description
  std::string unit{};      ///< unit of the values: "m", "rad", ...; empty for a dimensionless quantity
  Raster<float> values{};  ///< values of the cells; NaN marks cells without data
};

/// Path and coordinate reference system (CRS) of a GeoTIFF file.
struct GeoTiff {
  std::string path{};
  /// Coordinate system of the file; null: local metres without a CRS.
  const Georeference* georeference = nullptr;
  /// Output file that the caller commits. Null: the writing function creates `path` and commits it.
  OutputFile* into = nullptr;
};

/// Writes layers on a common grid as bands of a tiled, compressed GeoTIFF file. The file replaces file.path
/// atomically (OutputFile). @throws InputError if the file cannot be written, std::invalid_argument if the
/// grids of the layers differ or if there is no layer
void writeGeoTiff(const GeoTiff& file, const std::vector<Layer>& layers);

/// Name and display colour of a class of an integer raster.
struct NamedClass {
  std::string name{};
  std::array<std::uint8_t, 3> colour{};  ///< red, green, blue
};

/// Writes an integer raster (terrain classes, masks) as a GeoTIFF file with one band named `name`. The file
/// declares `nodata` as the value of cells without data. With `classes`, entry i gives the name (band item
/// CLASS_i) and the colour of the value i, and the file has overviews, i.e. coarser copies whose cells are
/// the maximum of the cells that they cover. @throws InputError if the file cannot be written,
/// std::invalid_argument for an empty raster
void writeGeoTiff(const GeoTiff& file, const std::string& name, const Raster<std::uint8_t>& values,
                  std::optional<std::uint8_t> nodata, const std::vector<NamedClass>& classes = {});

/// Class number of a cell without a terrain class.
inline constexpr std::uint8_t kNoClass = 255;

/// File and band of a layer, i.e. of a raster in addition to the elevation.
struct LayerSource {
  std::string path{};
  /// Band number from 1; unset: the band whose description fits the layer, or otherwise the first band.
  std::optional<int> band{};
};

/// Returns the terrain classes (0 to 254) of a file on the grid of the map. A cell receives the weakest of
/// the classes whose pixels overlap the cell, so that a small weak area between cell centres is kept. The
/// order from strong to weak is: the classes in the order of `weakest_last`; the other classes by number;
/// kNoClass (no data). @throws InputError, also if the file and the map do not overlap or a value is not a
/// class number
Raster<std::uint8_t> readTerrainClasses(const LayerSource& source, const ElevationMap& map,
                                        std::span<const int> weakest_last = {});

/// Rock abundance on the grid of the map: each cell has the maximum of all pixels of the file that overlap
/// the cell.
struct RockAbundance {
  /// Rock abundance: fraction of the area covered by rocks, 0 to 1; NaN without data [-].
  Raster<float> share;
  Raster<std::uint8_t> unseen;  ///< non-zero if the file has no data in a part of the cell
};

/// Returns the rock abundance of a file on the grid of the map. @throws InputError, also if the file and the
/// map do not overlap or a value lies outside 0 to 1
RockAbundance readRockAbundance(const LayerSource& source, const ElevationMap& map);

/// Additional drive cost per metre on the grid of the map: each cell has the maximum of all pixels of the
/// file that overlap the cell. An infinite cost (at least one pixel is infinite) means that the cell is
/// impassable. NaN means that no pixel is infinite and that a part of the cell has no data.
struct AddedJoules {
  /// Additional cost [J/m].
  Raster<float> J_per_m;
  float highest_J_per_m = 0.0F;  ///< maximum finite cost of the whole file [J/m]
};

/// Returns the additional costs of a file on the grid of the map. @throws InputError, also if the file and
/// the map do not overlap or a finite value lies outside 0 to 1e6
AddedJoules readAddedJoules(const LayerSource& source, const ElevationMap& map);

/// Returns a picture, such as an orthophoto, in the cells of a map's grid: red, green and blue in the bytes 0xFFRRGGBB,
/// averaged over each cell, and 0 where the file has none. @throws InputError, also for a file whose bands are not of 8
/// bits, or if only one of file and map has a CRS
Raster<std::uint32_t> readImage(const std::string& path, const std::optional<Georeference>& georeference,
                                const Grid& grid);

/// Keep-out areas, which the rover must not enter, on the grid of the map.
struct KeepOut {
  Raster<std::uint8_t> mask;       ///< 1 in every cell that a keep-out polygon touches, 0 in other cells
  std::vector<std::string> notes;  ///< one sentence about the features of the file outside the map
};

/// Returns the keep-out areas of a vector file with polygons. A GeoJSON file has longitudes and latitudes, or
/// map coordinates if the map has no CRS or the file states "crs": "local". Polygons are rasterised
/// separately, so that a hole of one polygon does not remove the area of another. @throws InputError, also if
/// a feature is not a polygon or has no area, or if no polygon overlaps the map
KeepOut readKeepOut(const std::string& path, const ElevationMap& map);

/// Returns the map coordinates [m] of a position that the user stated, which must lie inside the map. `text`
/// is "x,y", "lat,lon" with a trailing d on each number, or the path of a GeoJSON file. Of a GeoJSON file,
/// the first point is used (longitude and latitude, or map metres if the file has "crs": "local"). `name`
/// begins the error message ("--start"). @throws InputError
Point readPlace(const std::string& text, const ElevationMap& map, const std::string& name);

}  // namespace talus::maps
