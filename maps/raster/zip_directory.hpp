#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace talus::maps {

/// What the central directory of a zip archive states of a file in it.
struct ZipEntry {
  std::uint32_t crc = 0;  ///< CRC-32 of its content
  bool encrypted = false;
  std::uint64_t stored = 0;  ///< bytes in the archive
  std::uint64_t size = 0;    ///< bytes of its content, as stated
};

/// The files of a zip archive by name. Throws InputError when its directory is damaged or missing.
std::map<std::string, ZipEntry> zipDirectory(const std::string& path);

/// CRC-32 as zip has it (IEEE 802.3, reflected).
std::uint32_t crc32(const std::string& bytes) noexcept;

}  // namespace talus::maps
