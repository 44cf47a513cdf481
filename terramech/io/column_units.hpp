#pragma once

#include <string>
#include <vector>

namespace talus::terramech {

/// Throws InputError with file, column, and the name and unit to write, if the header contains a known column
/// under another name. Otherwise the column would count as an unknown column, and its measurements would be
/// ignored. Errors are: another unit (`sinkage_mm` for `sinkage_m`; a mass for a force, percent for a ratio
/// or an angle), a missing unit (`sinkage`; except time and axes), other spelling (`Load_N`, `load [N]`).
/// `known` lists names with their unit as suffix. Any other name, and any name in a file that also contains
/// the known column, is accepted as an unknown column (`sinkage_note`, `load_cell_id`).
void checkColumnUnits(const std::vector<std::string>& header, const std::vector<std::string>& known,
                      const std::string& file);

}  // namespace talus::terramech
