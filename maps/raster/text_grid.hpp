#pragma once

#include <string>

namespace talus::maps {

/// Refuses an Arc/Info ASCII grid with a word among its values that is no number: GDAL takes it for 0, which is ground.
/// nan, inf and what ESRI's programs write for them are numbers here. Throws InputError with file, line and word.
void refuseWordsInGrid(const std::string& path);

}  // namespace talus::maps
