#pragma once

#include <string>
#include <vector>

namespace talus::cli {

/// The string literals of a C++ source as the compiler joins them, in order; those of comments and of include
/// lines are left out. An escaped quote stays escaped.
std::vector<std::string> stringLiterals(const std::string& source);

}  // namespace talus::cli
