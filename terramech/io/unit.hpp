#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace talus::terramech {

/// Factor from a unit to another of the same kind (value_in_b = factor * value_in_a), none when the kinds
/// differ or a unit is not known. Names as they stand in suffixes: "deg" to "rad", "kPa" to "Pa".
std::optional<double> conversion(std::string_view from, std::string_view to);

/// The units of the kind of one, for a person: "N, mN, kN"; empty for what is none.
std::string unitsLike(std::string_view unit);

/// The longest known unit that ends a name after an underscore ("cohesion_kPa": "kPa"), or empty.
std::string_view unitOf(std::string_view name);

}  // namespace talus::terramech
