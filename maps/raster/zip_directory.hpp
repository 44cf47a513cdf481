#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace talus::maps {

/// Entry of one file in the central directory of a zip archive.
struct ZipEntry {
  std::uint32_t crc = 0;  ///< CRC-32 of the content
  bool encrypted = false;
  std::uint64_t stored = 0;  ///< compressed size [bytes]
  std::uint64_t size = 0;    ///< uncompressed size that the directory states [bytes]
};

/// Returns the entries of a zip archive by file name. Throws InputError if the central directory is damaged
/// or missing.
std::map<std::string, ZipEntry> zipDirectory(const std::string& path);

/// Returns the CRC-32 checksum of bytes as in zip archives (IEEE 802.3, reflected).
std::uint32_t crc32(const std::string& bytes) noexcept;

}  // namespace talus::maps
