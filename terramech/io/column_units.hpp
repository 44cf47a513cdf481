#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace talus::terramech {

/// Returns the factor between two units of the same kind: value in `to` = factor * value in `from`. Units
/// have the names of column suffixes, for example "deg" and "rad". Returns nullopt if the units are of
/// different kinds or a unit is unknown.
std::optional<double> conversion(std::string_view from, std::string_view to);

/// Returns the names of all units of the same kind, for messages ("N, mN, kN"); an empty text for an unknown
/// unit.
std::string unitsLike(std::string_view unit);

/// Returns the longest known unit that follows an underscore at the end of a name ("kPa" of "cohesion_kPa"),
/// or an empty text.
std::string_view unitOf(std::string_view name);

/// Returns a name without its unit ("cohesion" of "cohesion_kPa").
std::string stemOf(std::string_view name);

/// Returns a name with separators replaced by `_` and the signs % and degree by words: "load [N]" becomes "load_N".
std::string plainName(std::string_view name);

/// Appends the units of a row below the header ("N", "[m/s]", "%") to the names. Returns false and changes nothing if
/// a field is a number or none is a known unit. @throws InputError if a name states another unit
bool takeUnits(std::vector<std::string>& header, const std::vector<std::string>& row,
               const std::string& file);

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
