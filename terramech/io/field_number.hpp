#pragma once

#include <string_view>

namespace talus::terramech {

/// The number that a whole field states ("1", "-2.5e3", "+4", "nan", "inf"), or false. `.` decimals whatever
/// the locale.
bool parseNumber(std::string_view field, double& value) noexcept;

}  // namespace talus::terramech
