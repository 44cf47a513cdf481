#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <talus/common/input_error.hpp>
#include <talus/common/memory_budget.hpp>
#include <talus/maps/raster/file_text.hpp>
#include <talus/maps/raster/numpy_array.hpp>
#include <talus/maps/raster/numpy_raster.hpp>
#include <talus/maps/raster/zip_directory.hpp>

namespace talus::maps {
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
