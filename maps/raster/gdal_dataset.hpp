#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <talus/common/input_file.hpp>
#include <talus/maps/raster/gdal_handle.hpp>

class GDALDataset;
class GDALDriver;

namespace talus::maps {

/// Registers the allowed GDAL drivers (file formats), once per process, and removes all other drivers.
void registerDrivers();

/// Returns GDAL's short names of the drivers that openRaster() tries.
std::vector<std::string> rasterFormats();

/// Opens a raster file for reading with a driver of rasterFormats(). Rejects network paths, archives, and
/// files outside the folder of `path` (checkFiles()). A virtual raster (VRT) is accepted only if `allow_vrt`.
/// @throws InputError if the file is missing, a directory, unreadable, truncated, without a raster, or a TIFF
/// of whose structure GDAL warns
Dataset openRaster(const std::string& path, bool allow_vrt = false);

/// Returns GDAL's short names of the drivers that openVector() tries.
std::vector<std::string> vectorFormats();

/// Opens a vector file with a driver of vectorFormats() under the restrictions of openRaster(). @throws
/// InputError
Dataset openVector(const std::string& path);

/// Returns a file, filesOf() it if it is a raster or vector file, and the checksum files of all.
std::vector<InputFile> filesOpenedWith(const std::string& path);

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
