#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// Returns the optimal string alignment distance of two words: the least number of edits that change one word
/// into the other. An edit inserts, deletes or replaces one letter, or swaps two adjacent letters.
std::size_t editDistance(std::string_view a, std::string_view b);

/// Returns the known name with the smallest editDistance() to a mistyped word. Returns an empty text if no
/// name is within max(2, length of the word / 3) edits, or if the word is longer than 100 characters.
std::string nearestName(std::string_view word, const std::vector<std::string>& known);

}  // namespace talus
