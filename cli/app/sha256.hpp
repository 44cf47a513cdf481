#pragma once

#include <string>

namespace talus::cli {

/// Returns the SHA-256 of a file's bytes as 64 hexadecimal digits (FIPS 180-4 [fips_180_4]); empty if the
/// file cannot be read.
std::string sha256OfFile(const std::string& path);

/// Compares a file with the checksum in PATH.sha256 (format of sha256sum), if that file exists. Throws
/// InputError if the checksums differ.
void compareChecksum(const std::string& path);

}  // namespace talus::cli
