#pragma once

#include <string>
#include <vector>

namespace talus::terramech {

/// Throws InputError with file, column, and the name and unit to write, if the header contains a known column
/// under another name. Such a column would otherwise be kept as the user's own and its measurements ignored.
/// Errors are: another unit (`sinkage_mm` for `sinkage_m`; a mass for a force, percent for a ratio or an
/// angle), a missing unit (`sinkage`; except time and axes), other spelling (`Load_N`, `load [N]`). `known`
/// lists names with their unit as suffix. Any other name, and any name in a file that also has the known
/// column, is the user's own (`sinkage_note`, `load_cell_id`).
void checkColumnUnits(const std::vector<std::string>& header, const std::vector<std::string>& known,
                      const std::string& file);

}  // namespace talus::terramech
