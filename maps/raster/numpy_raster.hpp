#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <talus/maps/raster/gdal_dataset.hpp>

namespace talus::maps {

/// A NumPy array of numbers, converted to double, in C order (last index fastest).
struct NumpyArray {
  std::vector<std::size_t> shape;  ///< size of each dimension; empty for a scalar
  std::vector<double> values;
};

/// Returns the array that the bytes of a .npy file contain (format versions 1 to 3; integers, float32,
/// float64; either byte order). `where` names the file in error messages. @throws InputError
NumpyArray parseNumpy(const std::string& bytes, const std::string& where);

/// Entry of one file in the central directory of a zip archive.
struct ZipEntry {
  std::uint32_t crc = 0;  ///< CRC-32 of the content
  bool encrypted = false;
  std::uint64_t stored = 0;  ///< compressed size [bytes]
  std::uint64_t size = 0;    ///< uncompressed size that the directory states [bytes]
};

/// Returns the entries of a zip archive by file name. Throws InputError if the central directory is damaged
/// or missing.
std::map<std::string, ZipEntry> zipDirectory(const std::string& path);

/// Returns the CRC-32 checksum of bytes as in zip archives (IEEE 802.3, reflected).
std::uint32_t crc32(const std::string& bytes) noexcept;

/// Returns true if the path ends in .npy or .npz.
bool isNumpyFile(const std::string& path);

/// Opens a NumPy elevation grid as an in-memory raster, with north up. Reads the array of a .npy file. Of a
/// .npz archive, reads the array "elevation" or, if this is missing, the only two-dimensional array. The
/// scalars xmin, xmax, ymin, ymax of an archive, if present, are the outer edges of the grid, in degrees on
/// WGS 84 if their magnitudes permit. Limits in reverse order are swapped, and `notes` records the swap.
/// @throws InputError
Dataset openNumpyRaster(const std::string& path, std::vector<std::string>& notes);

}  // namespace talus::maps
