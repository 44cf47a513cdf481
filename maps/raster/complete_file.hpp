#pragma once

#include <cstdint>
#include <string>

class GDALDataset;

namespace talus::maps {

/// Throws InputError if the file of an open raster differs from what its header states: shorter (also netCDF-3
/// and text grids, which GDAL fills up) or, for rasters of plain numbers, longer; a text that ends within a
/// number; an image of a GeoTIFF that is neither raster, overview nor mask; pixels that GDAL reads as other
/// numbers (signed bytes, some types of PDS). Also checks the sources of a
/// virtual raster (VRT). For other formats, GDAL's drivers reject truncated files on reading
/// (tests/maps/raster/complete_file_test.cpp truncates a file of each format).
void refuseDamaged(GDALDataset& dataset, const std::string& path);

/// Throws InputError if blocks of a band of a GeoTIFF were never written and the band has no no-data value:
/// GDAL would read zeros. The block offsets in the file decide. For a VRT, all bands of its source files are
/// checked.
void refuseLostBlocks(GDALDataset& dataset, int band, const std::string& path);

/// Returns the value of the first line KEYWORD = VALUE of a PDS3 label, without quotes; empty if there is none.
/// With `object`, only lines of the first such object of the label count.
std::string pds3Keyword(const std::string& path, const std::string& keyword, const std::string& object = "");

/// Returns the number of values of an Arc/Info ASCII grid. Throws InputError with file, line and word for a word
/// among them that is not a number: GDAL would read 0. Accepts nan, inf and the spellings of both by ESRI's
/// programs.
std::uintmax_t valuesOfGrid(const std::string& path);

}  // namespace talus::maps
