#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace talus::terramech {

/// Returns the factor from one unit to another of the same kind (value_in_to = factor * value_in_from); empty
/// if the kinds differ or a unit is unknown. Names are those of suffixes: "deg" to "rad", "kPa" to "Pa".
std::optional<double> conversion(std::string_view from, std::string_view to);

/// Returns the units of the same kind for messages: "N, mN, kN"; empty for an unknown unit.
std::string unitsLike(std::string_view unit);

/// Returns the longest known unit at the end of a name, after an underscore ("cohesion_kPa": "kPa"), or an
/// empty text.
std::string_view unitOf(std::string_view name);

}  // namespace talus::terramech
