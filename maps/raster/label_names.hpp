#pragma once

#include <string>
#include <vector>

namespace talus::maps {

/// What of a raster file's text sends GDAL to other files.
struct LabelNames {
  bool virtual_raster = false;  ///< the text is a VRT
  bool code = false;            ///< a VRT that names a function, a program or one of GDAL's own file systems
  std::vector<std::string> names;  ///< of files, as GDAL reads them: escapes and quotes resolved
};

/// Names of files in a VRT, a PDS4, PDS3 or ISIS label; nothing of any other file. `path` names the file in errors.
/// Throws InputError when a label is too long to be checked or holds no XML.
LabelNames labelNames(const std::string& path);

/// Overviews and grids of positions that auxiliary metadata (.aux.xml) name, as labelNames().
std::vector<std::string> auxiliaryNames(const std::string& path);

}  // namespace talus::maps
