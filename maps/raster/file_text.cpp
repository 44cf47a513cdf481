#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <unistd.h>

#include <talus/common/input_error.hpp>
#include <talus/common/input_file.hpp>
#include <talus/maps/raster/file_text.hpp>

namespace talus::maps {

void requireReadableFile(const std::string& path, const std::string& role) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError({path, "no such file", "check the path"});
  if (!std::filesystem::is_regular_file(status) && !std::filesystem::is_directory(status))
    throw InputError({path, "is a device, a FIFO or a socket", "give a file"});
  if (std::filesystem::is_directory(status))
    throw InputError({path, "is a directory, not a file", "name the file inside it"});
  if (::access(path.c_str(), R_OK) != 0)
    throw InputError({path, std::string("cannot be read: ") + std::strerror(errno), "check its permissions"});
  if (std::filesystem::is_regular_file(status) && std::filesystem::file_size(path, error) == 0)
    throw InputError({path, "is empty", "fetch it again"});
  checkInput(path, role);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

std::uint64_t littleEndian(const std::string& bytes, std::size_t at, std::size_t count) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i)
    value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

}  // namespace talus::maps
