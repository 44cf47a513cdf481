#pragma once

#include <string>

namespace talus::cli {

/// SHA-256 of a file's bytes as 64 hexadecimal digits (FIPS 180-4 [fips_180_4]); empty when it cannot be
/// read.
std::string sha256OfFile(const std::string& path);

}  // namespace talus::cli
