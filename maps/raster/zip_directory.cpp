// File format: PKWARE, APPNOTE.TXT - .ZIP File Format Specification, sections 4.3.12 and 4.3.16.
#include <algorithm>
#include <fstream>

#include <boost/crc.hpp>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/file_text.hpp>
#include <talus/maps/raster/zip_directory.hpp>

namespace talus::maps {
namespace {

[[noreturn]] void refuse(const std::string& path) {
  throw InputError(
      {path, "is not a NumPy archive: its directory of files is damaged or missing", "fetch it again"});
}

std::string bytesAt(std::ifstream& file, std::streamoff begin, std::size_t count) {
  std::string bytes(count, '\0');
  file.clear();
  file.seekg(begin);
  file.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return bytes;
}

}  // namespace

std::uint32_t crc32(const std::string& bytes) noexcept {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

std::map<std::string, ZipEntry> zipDirectory(const std::string& path) {
  constexpr std::size_t kEnd = 22, kEntry = 46, kMostDirectory = std::size_t{16} << 20U;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::streamoff>(file.tellg());
  if (!file || size < static_cast<std::streamoff>(kEnd)) refuse(path);
  // A comment of at most 65535 bytes may follow the end-of-central-directory record.
  const std::streamoff tail_begin = std::max<std::streamoff>(0, size - 65535 - static_cast<int>(kEnd));
  const std::string tail = bytesAt(file, tail_begin, static_cast<std::size_t>(size - tail_begin));
  const std::size_t end = tail.rfind("PK\5\6");
  if (end == tail.npos || tail.size() - end < kEnd) refuse(path);
  const std::size_t length = littleEndian(tail, end + 12, 4);
  if (length > kMostDirectory) refuse(path);
  const std::string directory =
      bytesAt(file, static_cast<std::streamoff>(littleEndian(tail, end + 16, 4)), length);
  std::map<std::string, ZipEntry> entries;
  for (std::size_t at = 0; at < directory.size();) {
    if (directory.size() - at < kEntry || directory.compare(at, 4, "PK\1\2") != 0) refuse(path);
    const std::size_t name = littleEndian(directory, at + 28, 2);
    if (directory.size() - at - kEntry < name) refuse(path);
    const bool encrypted = (littleEndian(directory, at + 8, 2) & 1U) != 0;
    const ZipEntry entry{static_cast<std::uint32_t>(littleEndian(directory, at + 16, 4)), encrypted,
                         littleEndian(directory, at + 20, 4), littleEndian(directory, at + 24, 4)};
    if (!entries.emplace(directory.substr(at + kEntry, name), entry).second) refuse(path);
    at += kEntry + name + littleEndian(directory, at + 30, 2) + littleEndian(directory, at + 32, 2);
  }
  return entries;
}

}  // namespace talus::maps
