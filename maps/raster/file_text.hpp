#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

/// Checks and text helpers that are independent of the file format.
namespace talus::maps {

/// @throws InputError unless the path is a readable, non-empty regular file
void requireReadableFile(const std::string& path);

/// Converts ASCII letters to lower case.
std::string lower(std::string text);

/// Formats a number with at most six significant digits, for messages.
std::string number(double value);

/// The little-endian unsigned integer in the `count` bytes from index `at`; count <= 8.
std::uint64_t littleEndian(const std::string& bytes, std::size_t at, std::size_t count);

}  // namespace talus::maps
