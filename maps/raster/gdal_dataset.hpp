#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <talus/maps/raster/gdal_errors.hpp>

class GDALDataset;
class GDALDriver;

namespace talus::maps {

struct CloseDataset {
  void operator()(GDALDataset* dataset) const noexcept;
};

/// A GDAL dataset that closes itself once no virtual raster made from it needs it any more.
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

/// Makes the allowed drivers known to GDAL, once, and takes the others away.
void registerDrivers();

/// The names of the drivers that openRaster() tries.
std::vector<std::string> rasterFormats();

/// Opens a raster file for reading by a driver of that list; nothing from the network or an archive,
/// no file that names others (referenced_files.hpp). @throws InputError: missing, a directory, unreadable, not a
/// raster, no cells
Dataset openRaster(const std::string& path, bool allow_vrt = false);

/// The names of the drivers that openVector() tries.
std::vector<std::string> vectorFormats();

/// Opens a vector file by a driver of that list, with the same care. @throws InputError
Dataset openVector(const std::string& path);

/// Pixels that GDAL keeps in memory in the whole process, in bytes; left alone a twentieth of the machine's
/// memory.
void limitPixelCache(std::int64_t bytes);

/// The driver of a format by GDAL's name. @throws InputError where GDAL has none, as by GDAL_SKIP in the environment
GDALDriver& driverNamed(const char* name);

/// An empty raster in memory of one band of a GDALDataType, of 32-bit floats if none is given. @throws std::bad_alloc
Dataset memoryRaster(int width, int height, int type = 6);

}  // namespace talus::maps
