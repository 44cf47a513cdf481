#pragma once

#include <string>

namespace talus::maps {

/// Throws InputError if a raster file makes GDAL open files outside the folder of `path`. Rejects
///   - a virtual raster (VRT), unless `allow_vrt`;
///   - a VRT or a PDS4, PDS3 or ISIS label (header of a planetary image) that names a file with a path, or a
///     file that a link redirects out of the folder;
///   - a named or auxiliary file (.aux.xml, .ovr, .msk, .hdr, world files, ...) that is not a regular file.
/// Applies the same rules to every named file, up to eight levels deep. If `path` is a link, the folder of
/// its target is permitted, too.
void refuseForeignReferences(const std::string& path, bool allow_vrt);

}  // namespace talus::maps
