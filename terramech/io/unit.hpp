#pragma once

#include <optional>
#include <string>
#include <string_view>

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

}  // namespace talus::terramech
