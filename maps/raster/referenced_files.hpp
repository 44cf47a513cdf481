#pragma once

#include <string>

namespace talus::maps {

/// Refuses a raster file that sends GDAL elsewhere: a virtual raster (VRT) unless allowed; a VRT, a PDS4, PDS3 or ISIS
/// label that names a file with a path, or one that a link leads out of the label's folder; and the same of every file
/// that those name, eight levels deep, and of the auxiliary files that GDAL opens beside each (.aux.xml, .ovr, .msk, .hdr,
/// world files and the like), which must be regular files. The folder is that of `path` as given, or the one in which
/// the file itself lies where `path` is a link. Throws InputError.
void refuseForeignReferences(const std::string& path, bool allow_vrt);

}  // namespace talus::maps
