#pragma once

#include <string>

class GDALDataset;

namespace talus::maps {

/// Throws InputError if the file of an open raster is shorter than its header states, or ends within a
/// number. Checks the formats for which GDAL substitutes values for the missing bytes: ENVI, netCDF-3, text
/// grids and XYZ, and the sources of a VRT. Truncated files of other formats are rejected by GDAL's drivers
/// on reading (tests/maps/raster/complete_file_test.cpp truncates each format).
void refuseCutShort(GDALDataset& dataset, const std::string& path);

/// Throws InputError if blocks of a band or of its overviews were never written and the band has no no-data
/// value: GDAL would read zeros. For a VRT, all bands of its sources are checked.
void refuseLostBlocks(GDALDataset& dataset, int band, const std::string& path);

/// Throws InputError with file, line and word if an Arc/Info ASCII grid has a non-numeric word among its
/// values, which GDAL would read as 0. Accepts nan, inf and their spellings by ESRI's programs.
void refuseWordsInGrid(const std::string& path);

}  // namespace talus::maps
