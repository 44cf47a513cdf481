#pragma once

#include <string>
#include <vector>

namespace talus::maps {

/// References of a raster file to other files, as found in its text.
struct LabelNames {
  bool virtual_raster = false;  ///< true if the text is a VRT
  bool code = false;  ///< true if a VRT contains a pixel function or a path of GDAL's virtual file systems
  std::vector<std::string> names;  ///< file names as GDAL reads them: escapes and quotes resolved
};

/// File names in a VRT or a PDS4, PDS3 or ISIS label; empty for other files. `path` identifies the file in
/// errors. Throws InputError if a label exceeds the size limit or is not valid XML.
LabelNames labelNames(const std::string& path);

/// File names of overviews and geolocation grids in auxiliary metadata (.aux.xml). Errors as labelNames().
std::vector<std::string> auxiliaryNames(const std::string& path);

}  // namespace talus::maps
