#pragma once

#include <span>
#include <string>
#include <vector>

#include <talus/terramech/io/yaml_fields.hpp>

namespace talus::cli {

/// Description of a file format for users, or of a mapping inside such a file.
struct FileFormat {
  std::string title;
  std::string about;  ///< description in one sentence
  std::span<const terramech::FileKey> keys;
};

/// Returns the descriptions of all file formats, with the keys that their readers accept.
std::vector<FileFormat> fileFormats();

/// Returns the output of `talus help formats`.
std::string formatsText();

}  // namespace talus::cli
