#pragma once

#include <string_view>

namespace talus::terramech {

/// Returns true if a text is valid UTF-8 without NUL characters.
bool isText(std::string_view text);

}  // namespace talus::terramech
