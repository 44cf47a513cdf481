#pragma once

#include <span>
#include <string>
#include <vector>

#include <talus/terramech/io/file_keys.hpp>

namespace talus::cli {

/// A file format for users, or a mapping inside such a file.
struct FileFormat {
  std::string title;
  std::string about;  ///< one sentence
  std::span<const terramech::FileKey> keys;
};

/// All file formats, with the keys that their readers accept.
std::vector<FileFormat> fileFormats();

/// Output of `talus help formats`.
std::string formatsText();

/// The formats as Markdown: docs/formats.md from its first format heading onwards.
std::string formatsMarkdown();

}  // namespace talus::cli
