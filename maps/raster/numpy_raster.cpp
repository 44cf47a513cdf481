// File format: numpy.lib.format in NumPy's reference manual.
// File format: PKWARE, APPNOTE.TXT - .ZIP File Format Specification, sections 4.3.12 and 4.3.16.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <sstream>

#include <boost/crc.hpp>
#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <talus/common/common.hpp>
#include <talus/common/memory_budget.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/numpy_raster.hpp>

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

namespace {

[[noreturn]] void refuse(const std::string& path) {
  throw InputError(
      {path, "is not a NumPy archive: its directory of files is damaged or missing", "fetch it again"});
}

}  // namespace

std::uint32_t crc32(const std::string& bytes) noexcept {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

std::map<std::string, ZipEntry> zipDirectory(const std::string& path) {
  constexpr std::size_t kEnd = 22, kEntry = 46, kMostDirectory = std::size_t{16} << 20U;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::size_t>(std::max<std::streamoff>(0, file.tellg()));
  if (size < kEnd) refuse(path);
  // A comment of at most 65535 bytes may follow the end-of-central-directory record.
  const std::size_t longest = 65535 + kEnd, tail_begin = size > longest ? size - longest : 0;
  const std::string tail = bytesAt(file, tail_begin, size - tail_begin);
  const std::size_t end = tail.rfind("PK\5\6");
  if (end == tail.npos || tail.size() - end < kEnd) refuse(path);
  const std::size_t length = littleEndian(tail, end + 12, 4);
  if (length > kMostDirectory) refuse(path);
  const std::string directory = bytesAt(file, littleEndian(tail, end + 16, 4), length);
  std::map<std::string, ZipEntry> entries;
  for (std::size_t at = 0; at < directory.size();) {
    if (directory.size() - at < kEntry || directory.compare(at, 4, "PK\1\2") != 0) refuse(path);
    const std::size_t name = littleEndian(directory, at + 28, 2);
    if (directory.size() - at - kEntry < name) refuse(path);
    const bool encrypted = (littleEndian(directory, at + 8, 2) & 1U) != 0;
    const ZipEntry entry{static_cast<std::uint32_t>(littleEndian(directory, at + 16, 4)), encrypted,
                         littleEndian(directory, at + 20, 4), littleEndian(directory, at + 24, 4)};
    if (!entries.emplace(directory.substr(at + kEntry, name), entry).second) refuse(path);
    at += kEntry + name + littleEndian(directory, at + 30, 2) + littleEndian(directory, at + 32, 2);
  }
  return entries;
}

namespace {

using Arrays = std::map<std::string, NumpyArray>;

// Largest accepted file size [bytes]; larger rasters should be GeoTIFFs.
constexpr vsi_l_offset kMostBytes = vsi_l_offset{2} << 30;

// Limit of the compression ratio of arrays larger than kLarge; measured heights have lower ratios.
constexpr std::uint64_t kMostPacked = 500, kLarge = std::uint64_t{64} << 20;

struct Limits {
  double west, east, south, north;

  bool areDegrees() const {
    return std::abs(west) <= 360 && std::abs(east) <= 360 && std::abs(south) <= 90 && std::abs(north) <= 90;
  }
};

std::string slurp(const std::string& path, const std::string& where) {
  VSIStatBufL status{};
  if (VSIStatL(path.c_str(), &status) == 0) requireMemory(2.0 * static_cast<double>(status.st_size), where);
  GByte* bytes = nullptr;
  vsi_l_offset size = 0;
  if (VSIIngestFile(nullptr, path.c_str(), &bytes, &size, static_cast<GIntBig>(kMostBytes)) == FALSE)
    throw InputError(
        {where, "cannot be read or is larger than 2 GB", "fetch it again or convert it to GeoTIFF"});
  const std::unique_ptr<GByte, decltype(&CPLFree)> owner(bytes, CPLFree);
  return {reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size)};
}

Arrays readArchive(const std::string& path) {
  const std::string archive = "/vsizip/{" + path + "}";
  const CPLStringList names(VSIReadDir(archive.c_str()));
  const std::map<std::string, ZipEntry> directory = zipDirectory(path);
  Arrays arrays;
  for (int i = 0; i < names.size(); ++i) {
    const std::string name = names[i];
    if (!name.ends_with(".npy")) continue;
    const auto entry = directory.find(name);
    if (entry == directory.end())
      throw InputError({path + ", " + name, "is not in the directory", "fetch it again"});
    if (entry->second.encrypted)
      throw InputError({path + ", " + name, "is encrypted", "save it with numpy.savez"});
    if (const ZipEntry& e = entry->second; e.size > kLarge && e.size / kMostPacked > e.stored)
      throw InputError({path + ", " + name,
                        "states " + std::to_string(e.size) + " bytes in " + std::to_string(e.stored) +
                            ": more cells than such a file holds",
                        "fetch it again; a map of one height is better written as GeoTIFF"});
    const std::string content = slurp(archive + "/" + name, path);
    if (crc32(content) != entry->second.crc)
      throw InputError({path + ", " + name, "is damaged: its checksum is another", "fetch it again"});
    arrays[name.substr(0, name.size() - 4)] = parseNumpy(content, path + ", " + name);
  }
  if (arrays.empty())
    throw InputError({path, "is not a NumPy archive (no .npy inside)", "save it with numpy.savez"});
  return arrays;
}

std::string elevationName(const Arrays& arrays, const std::string& path) {
  if (arrays.contains("elevation")) return "elevation";
  std::string found;
  for (const auto& [name, array] : arrays) {
    if (array.shape.size() != 2) continue;
    if (!found.empty())
      throw InputError({path, "holds several arrays of two axes ('" + found + "', '" + name + "')",
                        "name the one with heights 'elevation'"});
    found = name;
  }
  if (found.empty())
    throw InputError({path, "holds no array of two axes", "name the one with heights 'elevation'"});
  return found;
}

std::optional<Limits> limitsOf(const Arrays& arrays) {
  std::array<double, 4> values{};
  const std::array<const char*, 4> names{"xmin", "xmax", "ymin", "ymax"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto found = arrays.find(names[i]);
    if (found == arrays.end() || found->second.values.size() != 1) return std::nullopt;
    values[i] = found->second.values[0];
  }
  return Limits{values[0], values[1], values[2], values[3]};
}

void order(double& low, double& high, const char* axis, std::vector<std::string>& notes) {
  if (low <= high) return;
  std::swap(low, high);
  notes.push_back(std::string(axis) + "min and " + axis + "max are in the wrong order in the file: swapped");
}

void georeference(GDALDataset& raster, Limits limits, std::vector<std::string>& notes) {
  order(limits.west, limits.east, "x", notes);
  order(limits.south, limits.north, "y", notes);
  double transform[6] = {limits.west, (limits.east - limits.west) / raster.GetRasterXSize(),  0, limits.north,
                         0,           (limits.south - limits.north) / raster.GetRasterYSize()};
  raster.SetGeoTransform(transform);
  if (!limits.areDegrees()) return;
  OGRSpatialReference wgs84;
  wgs84.SetWellKnownGeogCS("WGS84");
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  raster.SetSpatialRef(&wgs84);
  notes.emplace_back("limits read as degrees on WGS 84");
}

}  // namespace

bool isNumpyFile(const std::string& path) {
  return path.ends_with(".npz") || path.ends_with(".npy");
}

Dataset openNumpyRaster(const std::string& path, std::vector<std::string>& notes) {
  requireReadableFile(path, "cells");
  const GdalErrors errors;
  const Arrays arrays =
      path.ends_with(".npz") ? readArchive(path) : Arrays{{"elevation", parseNumpy(slurp(path, path), path)}};
  const std::string name = elevationName(arrays, path);
  const NumpyArray& heights = arrays.at(name);
  if (heights.shape.size() != 2 || heights.values.empty())
    throw InputError({path + ", array '" + name + "'", "has not two axes", "give rows by columns"});
  const int height = static_cast<int>(heights.shape[0]);
  const int width = static_cast<int>(heights.shape[1]);
  Dataset raster = memoryRaster(width, height);
  const CPLErr done = raster->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, width, height,
                                                         const_cast<double*>(heights.values.data()), width,
                                                         height, GDT_Float64, 0, 0, nullptr);
  if (done != CE_None) throw InputError({path, errors.last(), ""});
  if (const auto limits = limitsOf(arrays)) georeference(*raster, *limits, notes);
  return raster;
}

}  // namespace talus::maps
