#pragma once

#include <string>
#include <vector>

class GDALDataset;

namespace talus::maps {

/// Returns the files of an open raster or vector file, the named file first: data of labels, masks, overviews,
/// georeferences and styles as GDAL lists them, and the same of each source of a virtual raster (VRT).
/// Throws InputError if
///   - a file lies in another folder than `path` or the target of `path` (a link may not leave the folder), or
///     is not a regular file; or a VRT names a source by anything but a plain file name;
///   - a mask or auxiliary file that belongs to the raster by its name is not used by GDAL, as when
///     it is damaged, or an auxiliary file is no XML;
///   - a file differs from its checksum (checkInput()).
std::vector<std::string> sourceFiles(GDALDataset& dataset, const std::string& path);

/// Throws InputError if a file beside `path` that GDAL may open with it by its name is not a regular file:
/// opening a FIFO would wait for ever.
void requireRegularNeighbours(const std::string& path);

}  // namespace talus::maps
