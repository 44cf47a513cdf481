#pragma once

#include <span>
#include <string>
#include <vector>

#include <talus/terramech/io/file_keys.hpp>

namespace talus::cli {

/// A file that users write, or a mapping in it.
struct FileFormat {
  std::string title;
  std::string about;  ///< one sentence
  std::span<const terramech::FileKey> keys;
};

/// All of them, with the keys that their readers take.
std::vector<FileFormat> fileFormats();

/// What `talus help formats` prints.
std::string formatsText();

/// The same as Markdown: docs/formats.md from its first heading of a format on.
std::string formatsMarkdown();

}  // namespace talus::cli
