#pragma once

#include <string>

namespace talus::maps {

/// Refuses a raster file whose text sends GDAL elsewhere: a virtual raster (VRT) unless allowed, and then one that names
/// a file outside its own folder or anything but a file; a PDS4 or ISIS label that names a file with a path.
/// Throws InputError.
void refuseForeignReferences(const std::string& path, bool allow_vrt);

}  // namespace talus::maps
