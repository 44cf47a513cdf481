#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// The door of all input files.
namespace talus {

/// A file that a call reads, or that belongs to such a file.
struct InputFile {
  std::string path{};       ///< path as the call, or the file to which it belongs, names it
  std::string role{};       ///< what the file states: "elevation", "mask", "rover", ...; empty: unknown
  std::uintmax_t size = 0;  ///< [bytes]
  std::string sha256{};     ///< SHA-256 of the content, hexadecimal; empty without nettle
  bool used = true;         ///< false: named by an option or beside a file, and read by nothing
};

/// Records the files that pass checkInput() in this thread while the object exists. Inside another record the
/// outer one records.
class InputRecord {
 public:
  InputRecord();
  InputRecord(const InputRecord&) = delete;
  InputRecord& operator=(const InputRecord&) = delete;
  ~InputRecord();

 private:
  std::vector<InputFile> files_{};
};

/// Returns the manifest of this thread's record: each file once, in the order of reading, with size and SHA-256;
/// empty without a record.
std::vector<InputFile> filesRead();

/// Returns the SHA-256 of a file's bytes as 64 hexadecimal digits (FIPS 180-4 [fips_180_4]); empty if the
/// file cannot be read, or in a build without nettle (the on-board core).
std::string sha256OfFile(const std::string& path);

/// Records a file, and compares it with the checksum in PATH.sha256 (format of sha256sum), if that file exists and
/// the build has nettle. Every reader of a file calls this function before it reads. @throws InputError if
/// the checksums differ
void checkInput(const std::string& path, const std::string& role = "", bool used = true);

}  // namespace talus
