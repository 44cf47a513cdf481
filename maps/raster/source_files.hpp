#pragma once

#include <string>
#include <vector>

#include <talus/common/input_file.hpp>

class GDALDataset;

namespace talus::maps {

/// Returns the files of an open raster or vector file with their roles, the named file first: those that GDAL
/// lists, and those that belong to it by their names and that GDAL does not use. Neither sizes nor checksums.
std::vector<InputFile> filesOf(GDALDataset& dataset, const std::string& path);

/// Checks and records (checkInput()) filesOf() an open raster or vector file and of each source of a virtual raster
/// (VRT). Throws InputError if
///   - a file lies in another folder than `path` or the target of `path` (a link may not leave the folder), or
///     is not a regular file; or a VRT names a source by anything but a plain file name;
///   - a mask or auxiliary file that belongs to the raster by its name is not used by GDAL, as when
///     it is damaged, or an auxiliary file is no XML;
///   - a file differs from its checksum (checkInput()).
void checkFiles(GDALDataset& dataset, const std::string& path);

/// Throws InputError if a file beside `path` that GDAL may open with it by its name is not a regular file:
/// opening a FIFO would wait for ever.
void requireRegularNeighbours(const std::string& path);

}  // namespace talus::maps
