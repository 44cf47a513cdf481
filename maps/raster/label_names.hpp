#pragma once

#include <string>
#include <vector>

namespace talus::maps {

/// References of a raster file to other files, as found in the text of the raster file.
struct LabelNames {
  bool virtual_raster = false;  ///< true if the text is a virtual raster (VRT)
  bool code = false;  ///< true if a VRT contains a pixel function or a path of GDAL's virtual file systems
  std::vector<std::string> names;  ///< file names as GDAL reads them: escapes and quotes resolved
};

/// Returns the file names in a VRT or in a PDS4, PDS3 or ISIS label (header of a planetary image); no names
/// for other files. `path` also names the file in error messages. Throws InputError if a label exceeds the
/// size limit or is not valid XML.
LabelNames labelNames(const std::string& path);

/// Returns the file names of overviews and geolocation grids in the auxiliary metadata (.aux.xml) of `path`.
/// Throws the errors of labelNames().
std::vector<std::string> auxiliaryNames(const std::string& path);

}  // namespace talus::maps
