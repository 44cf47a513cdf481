#include <algorithm>
#include <cctype>
#include <fstream>
#include <initializer_list>
#include <string_view>
#include <utility>

#include <cpl_minixml.h>

#include <talus/common/input_error.hpp>
#include <talus/common/memory_budget.hpp>
#include <talus/maps/raster/file_text.hpp>
#include <talus/maps/raster/gdal_errors.hpp>
#include <talus/maps/raster/label_names.hpp>

namespace talus::maps {
namespace {

// Number of bytes searched for keywords of a label; GDAL searches fewer bytes.
constexpr std::size_t kBeginning = std::size_t{64} << 10U;
constexpr std::size_t kMostText = std::size_t{16} << 20U;  // size limit of a label or VRT
// Memory of the XML tree [bytes] per byte of text: the 4 bytes "<a/>" become a node of 100 bytes, and GDAL
// builds the tree twice.
constexpr double kTreePerByte = 50.0;

std::string read(std::ifstream& file, std::size_t most) {
  std::string text(most, '\0');
  file.read(text.data(), static_cast<std::streamsize>(most));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

std::string rest(std::ifstream& file, std::string start, const std::string& path) {
  start += read(file, kMostText);
  if (start.size() > kMostText)
    throw InputError({path, "has more than 16 MB of text, no label has", "give a GeoTIFF"});
  return start;
}

std::string withoutPrefix(std::string_view name) {
  const auto colon = name.rfind(':');
  return lower(std::string(colon == name.npos ? name : name.substr(colon + 1)));
}

// Calls `visit` for every text and attribute of an XML document with its enclosing element. Uses GDAL's own
// parser, so that names are checked exactly as GDAL reads them despite comments, CDATA or entities.
template <typename Visit>
void eachText(const std::string& text, const std::string& path, Visit&& visit) {
  requireMemory(kTreePerByte * static_cast<double>(text.size()), path);
  const GdalErrors errors;
  const CPLXMLTreeCloser tree(CPLParseXMLString(text.c_str()));
  if (!tree) throw InputError({path, "is no XML: " + errors.last(), "fetch it again"});
  std::vector<std::pair<const CPLXMLNode*, const CPLXMLNode*>> open{{tree.get(), nullptr}};
  while (!open.empty()) {
    const auto [node, parent] = open.back();
    open.pop_back();
    if (node->psNext != nullptr) open.emplace_back(node->psNext, parent);
    if (node->psChild != nullptr) open.emplace_back(node->psChild, node);
    if (node->eType == CXT_Text && parent != nullptr && node->pszValue != nullptr)
      visit(*parent, std::string(node->pszValue));
  }
}

bool isOneOf(const std::string& word, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(), [&](const char* other) { return word == other; });
}

// True if a metadata item names a file that GDAL opens: overviews, pixel geolocation arrays, or a DEM.
bool namesFile(const CPLXMLNode& item) {
  const char* key = CPLGetXMLValue(&item, "key", "");
  return isOneOf(lower(key), {"overview_file", "x_dataset", "y_dataset", "rpc_dem", "dempath"});
}

std::string withoutBase(const std::string& name) {
  constexpr std::string_view kBase = ":::BASE:::";
  return name.compare(0, kBase.size(), kBase) == 0 ? name.substr(kBase.size()) : name;
}

std::vector<std::string> names(const std::string& text, const std::string& path,
                               std::initializer_list<const char*> elements) {
  std::vector<std::string> out;
  eachText(text, path, [&](const CPLXMLNode& element, const std::string& value) {
    const std::string name = withoutPrefix(element.pszValue);
    if (isOneOf(name, elements)) out.push_back(value);
    if (isOneOf(name, {"mdi", "option"}) && namesFile(element)) out.push_back(withoutBase(value));
  });
  return out;
}

// Returns the index in `text` of the first character at or after `at` that is neither white space nor part of
// a comment of a PDS3 or ISIS label.
std::size_t skipBlanks(const std::string& text, std::size_t at) {
  while (at < text.size()) {
    if (std::isspace(static_cast<unsigned char>(text[at])) != 0)
      ++at;
    else if (text.compare(at, 2, "/*") == 0)
      at = std::min(text.size() - 2, text.find("*/", at + 2)) + 2;
    else if (text[at] == '#')
      at = std::min(text.size(), text.find('\n', at));
    else
      break;
  }
  return at;
}

// Appends the quoted and bare words of the value at `at`: a single word or the words of a list. An
// unterminated quote or list extends to the end of the text.
void valueWords(const std::string& text, std::size_t at, std::vector<std::string>& out) {
  const bool list = at < text.size() && (text[at] == '(' || text[at] == '{');
  if (list) ++at;
  for (bool first = true; first || list; first = false) {
    at = skipBlanks(text, at);
    if (at >= text.size() || text[at] == ')' || text[at] == '}') return;
    const char c = text[at];
    std::size_t end = 0;
    if (c == '"' || c == '\'') {
      end = std::min(text.size(), text.find(c, at + 1));
      out.push_back(text.substr(at + 1, end - at - 1));
      ++end;
    } else {
      end = std::min(text.size(), text.find_first_of(list ? " \t\r\n,(){}\"'" : " \t\r\n", at));
      out.push_back(text.substr(at, end - at));
      if (end == at) ++end;
    }
    at = end < text.size() && list && text[end] == ',' ? end + 1 : end;
  }
}

// Appends the values of pointers such as "^Core = name" and "^Table = (name, 5)".
void pointers(const std::string& text, std::vector<std::string>& out) {
  const auto in_key = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == ':'; };
  for (std::size_t at = text.find('^'); at != text.npos; at = text.find('^', at + 1)) {
    std::size_t equals = at + 1;
    while (equals < text.size() && in_key(static_cast<unsigned char>(text[equals]))) ++equals;
    equals = skipBlanks(text, equals);
    if (equals < text.size() && text[equals] == '=') valueWords(text, skipBlanks(text, equals + 1), out);
  }
}

// Label text as GDAL reads it: blocks of 512 bytes, each up to its first zero byte, until a line END. Image
// data may follow.
std::string labelText(std::ifstream& file, std::size_t begin) {
  file.clear();
  file.seekg(static_cast<std::streamoff>(begin));
  std::string text;
  while (text.size() < kMostText) {
    const std::string part = read(file, 512);
    if (part.empty()) break;
    const std::size_t checked = text.size() < 20 ? 0 : text.size() - 20;
    text += part.c_str();
    for (const char* end : {"\r\nEND\r\n", "\nEND\n", "\r\nEnd\r\n", "\nEnd\n"})
      if (text.find(end, checked) != text.npos) return text;
  }
  return text;
}

}  // namespace

LabelNames labelNames(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text = read(file, kBeginning);
  // a label is text and ends before the first zero byte
  const std::string start = lower(text.substr(0, text.find('\0')));
  const auto has = [&](const char* word) { return start.find(word) != start.npos; };
  if (has("<vrtdataset")) {
    text = rest(file, std::move(text), path);
    const std::string all = lower(text);
    const bool code = all.find("pixelfunction") != all.npos || all.find("/vsi") != all.npos;
    return {true, code,
            names(text, path,
                  {"sourcefilename", "sourcedataset", "sourceband", "overview", "maskfile", "dempath",
                   "filename"})};
  }
  if (has("<product_") || has("product_observational") || has("product_ancillary") ||
      has("product_collection"))
    return {false, false, names(rest(file, std::move(text), path), path, {"file_name"})};
  LabelNames label;
  if (has("isiscube")) pointers(labelText(file, 0), label.names);
  if (has("pds_version_id")) pointers(labelText(file, start.find("pds_version_id")), label.names);
  return label;
}

std::vector<std::string> auxiliaryNames(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return names(rest(file, read(file, kBeginning), path), path, {});
}

}  // namespace talus::maps
