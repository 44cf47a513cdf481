#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

/// Text and numbers of files, before any format is known.
namespace talus::maps {

/// @throws InputError unless the path is a file that can be read and is not empty
void requireReadableFile(const std::string& path);

/// ASCII letters in lower case.
std::string lower(std::string text);

/// A number with at most six digits, for messages.
std::string number(double value);

/// The whole number in `count` bytes from `at`, least significant first; count <= 8.
std::uint64_t littleEndian(const std::string& bytes, std::size_t at, std::size_t count);

}  // namespace talus::maps
