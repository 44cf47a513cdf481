#pragma once

#include <string>

/// The door of all input files.
namespace talus {

/// Returns the SHA-256 of a file's bytes as 64 hexadecimal digits (FIPS 180-4 [fips_180_4]); empty if the
/// file cannot be read, or in a build without nettle (the on-board core).
std::string sha256OfFile(const std::string& path);

/// Compares a file with the checksum in PATH.sha256 (format of sha256sum), if that file exists. Every reader of
/// a file calls this function before it reads. Does nothing in a build without nettle. @throws InputError if
/// the checksums differ
void checkInput(const std::string& path);

}  // namespace talus
