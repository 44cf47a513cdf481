#pragma once

#include <string>
#include <vector>

namespace talus::terramech {

/// Throws InputError if the header of a file contains a known column under another name or unit. The message
/// names file and column, and the name and unit to write. Without this check the column would count as an
/// unknown column, and its measurements would be ignored. Errors are another unit (`sinkage_mm` for
/// `sinkage_m`; a mass for a force, percent for a ratio or an angle), a missing unit (`sinkage`; except time
/// and axes), and another spelling (`Load_N`, `load [N]`). `known` lists the known columns with their unit as
/// suffix. Any other name (`sinkage_note`, `load_cell_id`) is accepted as an unknown column, and so is any
/// name in a file that also contains the known column.
void checkColumnUnits(const std::vector<std::string>& header, const std::vector<std::string>& known,
                      const std::string& file);

}  // namespace talus::terramech
