// File format: numpy.lib.format in NumPy's reference manual.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <regex>
#include <sstream>

#include <talus/common/input_error.hpp>
#include <talus/common/memory_budget.hpp>
#include <talus/maps/raster/file_text.hpp>
#include <talus/maps/raster/numpy_array.hpp>

namespace talus::maps {
namespace {

constexpr std::size_t kMostHeader = 10'000;  // limit of NumPy; also limits the recursion of std::regex

struct Header {
  char kind = 'f';       // integer (i), unsigned (u) or float (f)
  std::size_t size = 8;  // bytes per number
  bool swapped = false;
  bool fortran_order = false;
  std::vector<std::size_t> shape;
  std::size_t data_offset = 0;
};

[[noreturn]] void refuse(const std::string& where, const std::string& reason) {
  throw InputError({where, reason, "save it with numpy.save as a plain array of numbers"});
}

// Parses "2, 3", "2," or an empty shape.
std::vector<std::size_t> parseShape(const std::string& text, const std::string& where) {
  std::vector<std::size_t> shape;
  std::istringstream extents(text);
  for (std::string extent; std::getline(extents, extent, ',');) {
    const auto first = extent.find_first_not_of(' ');
    if (first == extent.npos) continue;
    extent = extent.substr(first, extent.find_last_not_of(' ') + 1 - first);
    if (extent.find_first_not_of("0123456789") != extent.npos)
      refuse(where, "the NumPy header has the extent '" + extent.substr(0, 20) + "'");
    if (extent.size() > 9) refuse(where, "array is too large");
    shape.push_back(std::stoul(extent));
  }
  return shape;
}

Header parseHeader(const std::string& bytes, const std::string& where) {
  if (bytes.size() < 12 || bytes.compare(0, 6, "\x93NUMPY") != 0) refuse(where, "not a NumPy array");
  if (bytes[6] < 1 || bytes[6] > 3)
    refuse(where, "the NumPy header is of version " + std::to_string(static_cast<unsigned char>(bytes[6])) +
                      ", must be 1 to 3");
  const std::size_t length_bytes = bytes[6] == 1 ? 2 : 4;
  const std::size_t begin = 8 + length_bytes;
  const std::size_t length = littleEndian(bytes, 8, length_bytes);
  if (length > bytes.size() - begin) refuse(where, "the NumPy header is cut short");
  if (length > kMostHeader) refuse(where, "the NumPy header is longer than 10000 characters");
  const std::string words = bytes.substr(begin, length);
  static const std::regex type("'descr': *'([<>|=])([iuf])([0-9])'");
  static const std::regex order("'fortran_order': *(True|False)");
  static const std::regex extent("'shape': *\\(([^)]*)\\)");
  std::smatch match;
  Header header;
  if (!std::regex_search(words, match, type)) refuse(where, "the array does not hold plain numbers");
  header.kind = match[2].str()[0];
  header.size = std::stoul(match[3].str());
  const bool big = match[1] == ">";
  header.swapped = header.size > 1 && big != (std::endian::native == std::endian::big);
  if (!std::regex_search(words, match, order)) refuse(where, "the NumPy header has no fortran_order");
  header.fortran_order = match[1] == "True";
  if (!std::regex_search(words, match, extent)) refuse(where, "the NumPy header has no shape");
  header.shape = parseShape(match[1], where);
  header.data_offset = begin + length;
  return header;
}

template <typename T>
double numberAt(const char* bytes, bool swapped) {
  std::array<char, sizeof(T)> raw;
  std::copy_n(bytes, sizeof(T), raw.begin());
  if (swapped) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<T>(raw));
}

using Convert = double (*)(const char*, bool);

Convert converter(const Header& h, const std::string& where) {
  const std::string type = h.kind + std::to_string(h.size);
  if (type == "i1") return numberAt<std::int8_t>;
  if (type == "u1") return numberAt<std::uint8_t>;
  if (type == "i2") return numberAt<std::int16_t>;
  if (type == "u2") return numberAt<std::uint16_t>;
  if (type == "i4") return numberAt<std::int32_t>;
  if (type == "u4") return numberAt<std::uint32_t>;
  if (type == "i8") return numberAt<std::int64_t>;
  if (type == "u8") return numberAt<std::uint64_t>;
  if (type == "f4") return numberAt<float>;
  if (type == "f8") return numberAt<double>;
  refuse(where, "numbers of type " + type + " are not supported");
}

}  // namespace

NumpyArray parseNumpy(const std::string& bytes, const std::string& where) {
  const Header header = parseHeader(bytes, where);
  const Convert convert = converter(header, where);
  const std::size_t most = (bytes.size() - header.data_offset) / header.size;
  std::size_t count = 1;
  for (std::size_t n : header.shape) {
    count *= n;
    if (count > most) throw InputError({where, "the file is cut short", "fetch it again"});
  }
  if (count > most) throw InputError({where, "the file is cut short", "fetch it again"});
  if (bytes.size() - header.data_offset != count * header.size)
    refuse(where, "has more bytes than its shape states");
  requireMemory(8.0 * static_cast<double>(count), where);
  NumpyArray array{header.shape, std::vector<double>(count)};
  const bool transposed = header.fortran_order && header.shape.size() == 2;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = transposed ? (i % header.shape[0]) * header.shape[1] + i / header.shape[0] : i;
    array.values[at] = convert(bytes.data() + header.data_offset + i * header.size, header.swapped);
  }
  return array;
}

}  // namespace talus::maps
