#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

#ifdef TALUS_NETTLE
#include <nettle/sha2.h>
#endif

#include <talus/common/common.hpp>

namespace talus {
namespace {

namespace fs = std::filesystem;

thread_local std::vector<InputFile>* manifest = nullptr;

void record(const std::string& path, const std::string& role, bool used) {
  if (manifest == nullptr) return;
  const auto known = std::ranges::find(*manifest, path, &InputFile::path);
  if (known == manifest->end())
    manifest->push_back({.path = path, .role = role, .used = used});
  else if (known->role.empty())
    known->role = role;
}

}  // namespace

InputRecord::InputRecord() {
  if (manifest == nullptr) manifest = &files_;
}

InputRecord::~InputRecord() {
  if (manifest == &files_) manifest = nullptr;
}

std::vector<InputFile> filesRead() {
  if (manifest == nullptr) return {};
  for (InputFile& file : *manifest) {
    std::error_code error;
    if (file.sha256.empty()) file.sha256 = sha256OfFile(file.path);
    if (const auto size = fs::file_size(file.path, error); !error) file.size = size;
  }
  return *manifest;
}

std::string sha256OfFile(const std::string& path) {
#ifdef TALUS_NETTLE
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
  std::array<char, 2 * SHA256_DIGEST_SIZE + 1> digits;
  for (std::size_t i = 0; i < digest.size(); ++i) std::snprintf(&digits[2 * i], 3, "%02x", digest[i]);
  return digits.data();
#else
  static_cast<void>(path);
  return "";
#endif
}

void checkInput(const std::string& path, const std::string& role, bool used) {
  record(path, role, used);
  const std::string sums = path + ".sha256";
  std::error_code error;
  if (!fs::is_regular_file(path, error) || !fs::is_regular_file(sums, error)) return;
  // The line that names the file, or else the first.
  std::string stated, name = fs::path(path).filename().string();
  std::ifstream lines(sums);
  for (std::string line; std::getline(lines, line);) {
    line.erase(line.find_last_not_of(" \t\r") + 1);
    const bool named = line.ends_with(name) && line.size() > 64 + name.size();
    if (stated.empty() || named) stated = line.substr(0, line.find_first_of(" \t"));
    if (named) break;
  }
  std::ranges::transform(stated, stated.begin(), [](unsigned char c) { return std::tolower(c); });
  if (stated.size() != 64 || stated.find_first_not_of("0123456789abcdef") != stated.npos)
    throw InputError({sums, "does not begin with a SHA-256", "write it by sha256sum, or remove it"});
  if (const std::string own = sha256OfFile(path); !own.empty() && own != stated)
    throw InputError({path, "is not the file of " + sums + ": changed or damaged since",
                      "get it again, or remove that file"});
}

}  // namespace talus
