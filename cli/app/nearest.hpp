#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace talus::cli {

/// The known word with the fewest edits (insert, delete, replace, swap neighbours) from the given one;
/// empty where none is within a third of its length.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

}  // namespace talus::cli
