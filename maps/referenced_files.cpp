#include <algorithm>
#include <cctype>
#include <fstream>
#include <string_view>

#include <talus/maps/referenced_files.hpp>
#include <talus/talus.hpp>

namespace talus::maps {
namespace {

constexpr std::size_t kMostText = std::size_t{16} << 20U;  // a label or a virtual raster is shorter

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

// In lower case; as much as a label may be.
std::string beginning(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(4096, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  const std::string start = lower(text);
  const bool label = start.find("<vrtdataset") != start.npos || start.find("<product_") != start.npos ||
                     start.find("isiscube") != start.npos || start.find("pds_version_id") != start.npos;
  if (!label || !file) return start;
  std::string rest(kMostText, '\0');
  file.read(rest.data(), static_cast<std::streamsize>(rest.size()));
  rest.resize(static_cast<std::size_t>(file.gcount()));
  return start + lower(rest);
}

[[noreturn]] void refuse(const std::string& path, const std::string& name) {
  throw InputError({path, "names '" + name.substr(0, 80) + "', which is no file of its own folder",
                    "put the files into one folder and name them without a path"});
}

// A name of a file beside the label, and nothing that GDAL would take for more.
void requirePlainName(const std::string& path, std::string_view name) {
  while (!name.empty() && std::isspace(static_cast<unsigned char>(name.front())) != 0) name.remove_prefix(1);
  const bool plain = name.find_first_of("/\\:&") == name.npos && name.find("..") == name.npos;
  if (!plain) refuse(path, std::string(name));
}

// Contents of every element of that name.
template <typename Visit>
void eachElement(const std::string& text, const std::string& tag, Visit&& visit) {
  for (std::size_t at = text.find("<" + tag); at != text.npos; at = text.find("<" + tag, at + 1)) {
    const std::size_t begin = text.find('>', at);
    const std::size_t end = text.find('<', begin);
    if (begin != text.npos && end != text.npos)
      visit(std::string_view(text).substr(begin + 1, end - begin - 1));
  }
}

// Values of "^Core = name", "^Table = (name, 5)" and the like: quoted or bare words, no numbers.
void checkPointers(const std::string& path, const std::string& text) {
  for (std::size_t at = text.find('^'); at != text.npos; at = text.find('^', at + 1)) {
    const std::size_t equals = text.find_first_of("=\n", at);
    if (equals == text.npos || text[equals] != '=' || equals - at > 80) continue;
    const std::size_t end = text.find('\n', equals);
    requirePlainName(path, std::string_view(text).substr(equals + 1, end - equals - 1));
  }
}

}  // namespace

void refuseForeignReferences(const std::string& path, bool allow_vrt) {
  const std::string text = beginning(path);
  if (text.find("<vrtdataset") != text.npos) {
    if (!allow_vrt)
      throw InputError(
          {path, "is a virtual raster, which names other files", "pass --allow-vrt if you trust it"});
    for (const char* tag : {"sourcefilename", "sourcedataset", "sourceband", "overview", "maskfile"})
      eachElement(text, tag, [&](std::string_view name) { requirePlainName(path, name); });
    if (text.find("pixelfunction") != text.npos || text.find("/vsi") != text.npos)
      refuse(path, "/vsi or code");
  } else if (text.find("<product_") != text.npos) {
    eachElement(text, "file_name", [&](std::string_view name) { requirePlainName(path, name); });
  } else if (text.find("isiscube") != text.npos || text.find("pds_version_id") != text.npos) {
    checkPointers(path, text);
  }
}

}  // namespace talus::maps
