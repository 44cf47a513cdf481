#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <talus/common/common.hpp>

class GDALDataset;
class GDALDriver;

/// Checks of files and text functions that are independent of the file format.
namespace talus::maps {

/// Checks that a file can be read, and calls checkInput() with its role. @throws InputError unless the path is a readable,
/// non-empty regular file
void requireReadableFile(const std::string& path, const std::string& role = "");

/// Returns GDAL's short name of a dataset's format; empty if it has none.
std::string_view driverOf(GDALDataset& dataset);

/// Returns the text with ASCII letters in lower case.
std::string lower(std::string text);

/// Returns a number as text with at most six significant digits, for messages.
std::string number(double value);

/// Returns the word behind the first word `key` (lower case) of a text file in any case; empty if there is none.
std::string wordBehind(std::string_view key, const std::string& path);

/// Returns the little-endian unsigned integer in the `count` <= 8 bytes from index `at`.
std::uint64_t littleEndian(const std::string& bytes, std::size_t at, std::size_t count);

/// Returns at most `count` bytes of a file from an offset; fewer at its end.
std::string bytesAt(std::ifstream& file, std::uintmax_t begin, std::size_t count);

struct CloseDataset {
  void operator()(GDALDataset* dataset) const noexcept;
};

/// An owned reference to a GDAL dataset. The dataset closes when its last reference is released; a virtual
/// raster derived from the dataset holds a reference, too.
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

/// Suppresses GDAL's error output of this thread during the lifetime of the object, and keeps it. Errors of an
/// inner object of the same thread are not kept by the outer one.
class GdalErrors {
 public:
  GdalErrors();
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;
  ~GdalErrors();

  /// Returns the first line of GDAL's last failure, or else of its last warning; "unknown error" if GDAL has
  /// reported neither.
  std::string last() const;
  /// Returns true if an error of class CE_Failure or worse was reported since construction.
  bool any() const { return failed_; }
  /// Returns true if a warning or an error was reported since construction.
  bool anyWarning() const { return !last_.empty(); }

 private:
  std::string last_{};
  bool failed_ = false;
};

/// Returns the files of an open raster or vector file with their roles, the named file first: those that GDAL
/// lists, and those that belong to it by their names and that GDAL does not use. Neither sizes nor checksums.
std::vector<InputFile> filesOf(GDALDataset& dataset, const std::string& path);

/// Checks and records (checkInput()) filesOf() an open raster or vector file and of each source of a virtual raster
/// (VRT). Throws InputError if
///   - a file lies in another folder than `path` or the target of `path` (a link may not leave the folder), or
///     is not a regular file; or a VRT names a source by anything but a plain file name;
///   - a mask or auxiliary file that belongs to the raster by its name is not used by GDAL, as when
///     it is damaged, or an auxiliary file is no XML;
///   - a file differs from its checksum (checkInput()).
void checkFiles(GDALDataset& dataset, const std::string& path);

/// Throws InputError if a file beside `path` that GDAL may open with it by its name is not a regular file:
/// opening a FIFO would wait for ever.
void requireRegularNeighbours(const std::string& path);

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

/// Throws InputError if the file of an open raster differs from what its header states: shorter (also netCDF-3
/// and text grids, which GDAL fills up) or, for rasters of plain numbers, longer; a text that ends within a
/// number; blocks and tags of a GeoTIFF that overlap, lie beyond its end or were never written without a no-data
/// value, or an image that is neither raster, overview nor mask; pixels that GDAL reads as other numbers (signed bytes, some types of PDS). Also checks the sources of a
/// virtual raster (VRT). For other formats, GDAL's drivers reject truncated files on reading
/// (tests/maps/raster/complete_file_test.cpp truncates a file of each format).
void refuseDamaged(GDALDataset& dataset, const std::string& path);

/// Returns the value of the first line KEYWORD = VALUE of a PDS3 label, without quotes; empty if there is none.
/// With `object`, only lines of the first such object of the label count.
std::string pds3Keyword(const std::string& path, const std::string& keyword, const std::string& object = "");

/// Returns the number of values of an Arc/Info ASCII grid. Throws InputError with file, line and word for a word
/// among them that is not a number: GDAL would read 0. Accepts nan, inf and the spellings of both by ESRI's
/// programs.
std::uintmax_t valuesOfGrid(const std::string& path);

}  // namespace talus::maps
