#pragma once

#include <string>

namespace talus::cli {

/// SHA-256 of a file's bytes as 64 hexadecimal digits (FIPS 180-4 [fips_180_4]); empty when it cannot be
/// read.
std::string sha256OfFile(const std::string& path);

/// Where a file PATH.sha256 lies beside a file, as sha256sum writes it, both must agree. Throws InputError where they do not.
void compareChecksum(const std::string& path);

}  // namespace talus::cli
