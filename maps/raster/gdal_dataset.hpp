#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <talus/maps/raster/gdal_errors.hpp>

class GDALDataset;
class GDALDriver;

namespace talus::maps {

struct CloseDataset {
  void operator()(GDALDataset* dataset) const noexcept;
};

/// An owned reference to a GDAL dataset. The dataset closes when its last reference is released; a virtual
/// raster derived from the dataset holds a reference, too.
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

/// Registers the allowed GDAL drivers (file formats), once per process, and removes all other drivers.
void registerDrivers();

/// Returns GDAL's short names of the drivers that openRaster() tries.
std::vector<std::string> rasterFormats();

/// Opens a raster file for reading with a driver of rasterFormats(). Rejects network paths, archives, and
/// files that refer to other files (referenced_files.hpp). A virtual raster (VRT) is accepted only if
/// `allow_vrt`. @throws InputError if the file is missing, a directory, unreadable, truncated, or without a
/// raster
Dataset openRaster(const std::string& path, bool allow_vrt = false);

/// Returns GDAL's short names of the drivers that openVector() tries.
std::vector<std::string> vectorFormats();

/// Opens a vector file with a driver of vectorFormats() under the restrictions of openRaster(). @throws
/// InputError
Dataset openVector(const std::string& path);

/// Sets the limit of GDAL's pixel cache for the whole process [bytes]. Default: 5 % of the physical memory.
void limitPixelCache(std::int64_t bytes);

/// Returns the GDAL driver with this name. @throws InputError if GDAL lacks the driver, for example because
/// of GDAL_SKIP
GDALDriver& driverNamed(const char* name);

/// An in-memory file that GDAL writes, removed by the destructor. GDAL may lose an error of the disk; the bytes
/// are therefore written by OutputFile.
struct MemoryFile {
  std::string name;  ///< path for GDAL

  explicit MemoryFile(const std::string& extension);
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile();

  /// Returns the content, valid until the file changes.
  std::string_view bytes() const;
};

/// Returns an empty in-memory raster with one band of the given GDALDataType (default 6: 32-bit float).
/// @throws std::bad_alloc
Dataset memoryRaster(int width, int height, int type = 6);

}  // namespace talus::maps
