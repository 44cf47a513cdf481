#pragma once

#include <string>

class GDALDataset;

namespace talus::maps {

/// Throws InputError where the file behind an open raster is shorter than what it states, or ends within a number, and GDAL
/// would make values of what is lost: ENVI, netCDF-3, text grids and XYZ; a VRT by its sources. What GDAL's drivers refuse by
/// themselves when it is read is left to them (tests/maps/raster/complete_file_test.cpp cuts every format that is opened).
void refuseCutShort(GDALDataset& dataset, const std::string& path);

/// Throws InputError where blocks of a band, or of its overviews, were never written and no value stands for that: GDAL
/// would read zeros.
void refuseLostBlocks(GDALDataset& dataset, int band, const std::string& path);

/// Refuses an Arc/Info ASCII grid with a word among its values that is no number: GDAL takes it for 0, which is ground.
/// nan, inf and what ESRI's programs write for them are numbers here. Throws InputError with file, line and word.
void refuseWordsInGrid(const std::string& path);

}  // namespace talus::maps
