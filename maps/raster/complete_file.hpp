#pragma once

#include <string>

class GDALDataset;

namespace talus::maps {

/// Throws InputError if the file of an open raster is shorter than its header states, or ends within a
/// number. Checks the formats for which GDAL replaces missing bytes by values: ENVI, netCDF-3, text grids and
/// XYZ, and the source files of a virtual raster (VRT). For other formats, GDAL's drivers reject truncated
/// files on reading (tests/maps/raster/complete_file_test.cpp truncates a file of each format).
void refuseCutShort(GDALDataset& dataset, const std::string& path);

/// Throws InputError if blocks of a band, or of its overviews (coarser copies), were never written and the
/// band has no no-data value: GDAL would read zeros. For a VRT, all bands of its source files are checked.
void refuseLostBlocks(GDALDataset& dataset, int band, const std::string& path);

/// Throws InputError with file, line and word if an Arc/Info ASCII grid has a word that is not a number among
/// its values: GDAL would read 0. Accepts nan, inf and the spellings of both by ESRI's programs.
void refuseWordsInGrid(const std::string& path);

}  // namespace talus::maps
