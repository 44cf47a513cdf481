#pragma once

#include <string>
#include <vector>

namespace talus::terramech {

/// Refuses a header that lacks a known column and writes it in another way than Talus reads it, which would make it a column
/// of the user's own and drop what was measured: with another unit (`sinkage_mm` for `sinkage_m`; a mass for a force,
/// percent for a ratio or an angle), without its unit (`sinkage`; but `time` and axes may be anything), in other letters or
/// signs (`Load_N`, `load [N]`). `known`: names with their unit as suffix. Any other name, and any beside the known column,
/// is the user's own (`sinkage_note`, `load_cell_id`). Throws InputError naming the file, the column, and the column and
/// unit to write.
void checkColumnUnits(const std::vector<std::string>& header, const std::vector<std::string>& known,
                      const std::string& file);

}  // namespace talus::terramech
