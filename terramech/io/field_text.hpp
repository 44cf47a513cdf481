#pragma once

#include <string_view>

namespace talus::terramech {

/// Parses a whole text field as a number ("1", "-2.5e3", "+4", "nan", "inf"), with `.` as decimal point in
/// any locale. Returns false if the field is not a number.
bool parseNumber(std::string_view field, double& value) noexcept;

/// Returns true if a text is valid UTF-8 without NUL characters.
bool isText(std::string_view text);

}  // namespace talus::terramech
