#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// The fewest edits that make one word the other: insert, delete or replace a letter, swap two neighbours
/// (optimal string alignment).
std::size_t editDistance(std::string_view a, std::string_view b);

/// The known name that a mistyped word most likely means: fewest edits; empty where none is within a third of
/// the word's length (two edits for short words).
std::string nearestName(std::string_view word, const std::vector<std::string>& known);

}  // namespace talus
