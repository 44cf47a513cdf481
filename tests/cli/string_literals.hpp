#pragma once

#include <string>
#include <vector>

namespace talus::cli {

/// String literals of a C++ source in order, adjacent literals joined; literals in comments and include lines
/// are omitted. Escape sequences are kept as written.
std::vector<std::string> stringLiterals(const std::string& source);

}  // namespace talus::cli
