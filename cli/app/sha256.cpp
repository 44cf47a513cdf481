#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <nettle/sha2.h>

#include <talus/cli/app/sha256.hpp>
#include <talus/common/input_error.hpp>

namespace talus::cli {

std::string sha256OfFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return "";
  sha256_ctx context;
  sha256_init(&context);
  std::array<char, 65536> buffer;
  while (file.read(buffer.data(), buffer.size()), file.gcount() > 0)
    sha256_update(&context, static_cast<std::size_t>(file.gcount()),
                  reinterpret_cast<const std::uint8_t*>(buffer.data()));
  std::array<std::uint8_t, SHA256_DIGEST_SIZE> digest;
  sha256_digest(&context, digest.size(), digest.data());
  std::string digits;
  for (const std::uint8_t byte : digest) digits += fmt::format("{:02x}", byte);
  return digits;
}

void compareChecksum(const std::string& path) {
  const std::string sums = path + ".sha256";
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || !std::filesystem::is_regular_file(sums, error))
    return;
  std::string stated;
  std::ifstream(sums) >> stated;
  std::ranges::transform(stated, stated.begin(), [](unsigned char c) { return std::tolower(c); });
  if (stated.size() != 64 || stated.find_first_not_of("0123456789abcdef") != stated.npos)
    throw InputError({sums, "does not begin with a SHA-256", "write it by sha256sum, or remove it"});
  if (sha256OfFile(path) != stated)
    throw InputError({path, "is not the file of " + sums + ": changed or damaged since",
                      "get it again, or remove that file"});
}

}  // namespace talus::cli
