#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <talus/maps/grid/grid.hpp>
#include <talus/maps/grid/lost_zeros.hpp>

class GDALDataset;

namespace talus::maps {

/// Value of cells without data in a raster of floats.
inline constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

/// Criteria for the choice of a band.
struct BandCriteria {
  std::string path{};                      ///< path in error messages
  std::optional<int> band{};               ///< selected by the user, from 1
  std::vector<std::string_view> words{};   ///< lower-case substrings of the description that select a band
  std::vector<std::string_view> others{};  ///< lower-case substrings of the description that exclude a band
};

/// Returns the selected band, else the first band whose description fits, else the first band. A choice among
/// several bands is recorded in `notes`. @throws InputError for a band that does not exist, or for a colour
/// image without a selected band
int chooseBand(GDALDataset& file, const BandCriteria& wish, std::vector<std::string>& notes);

/// A rectangle of pixels, counted from the upper left corner.
struct PixelBox {
  int column = 0;
  int row = 0;
  int width = 0;
  int height = 0;

  friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

/// Reads raw values of a band in file order; masked pixels and infinities are NaN. With overview > 1, returns
/// the mean of each block of overview x overview pixels, from the overviews of the file if present. The width
/// and height of the box are multiples of `overview`, or less than one. @throws InputError with GDAL's
/// message
std::vector<float> readPixels(GDALDataset& raster, int band, const PixelBox& box, const std::string& where,
                              int overview = 1);

/// Returns the cells of a box that were overwritten by zeros, found by LostZeros within the box. `nodata` is
/// the no-data value of the band; `zero_is_ordinary` as for LostZeros. @throws InputError
LostCells lostCells(GDALDataset& raster, int band, const PixelBox& box, std::optional<double> nodata,
                    const std::string& where, bool zero_is_ordinary = false);

/// Sets each value to NaN whose block of overview x overview pixels contains a lost cell.
void blank(const LostCells& lost, const PixelBox& box, int overview, std::vector<float>& values);

/// Message about lost cells; `remedy` is the option to use if 0 is their true value.
std::string lostNote(const LostCells& lost, const std::string& remedy);

/// Reverses the row order: values from north to south become a raster from south to north.
Raster<float> northUp(const Grid& grid, std::vector<float> values);

}  // namespace talus::maps
