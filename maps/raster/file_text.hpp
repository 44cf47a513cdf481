#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

/// Checks of files and text functions that are independent of the file format.
namespace talus::maps {

/// Checks that a file can be read, and calls checkInput() with its role. @throws InputError unless the path is a readable,
/// non-empty regular file
void requireReadableFile(const std::string& path, const std::string& role = "");

/// Returns the text with ASCII letters in lower case.
std::string lower(std::string text);

/// Returns a number as text with at most six significant digits, for messages.
std::string number(double value);

/// Returns the little-endian unsigned integer in the `count` <= 8 bytes from index `at`.
std::uint64_t littleEndian(const std::string& bytes, std::size_t at, std::size_t count);

}  // namespace talus::maps
