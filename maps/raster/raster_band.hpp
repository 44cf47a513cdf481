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

/// Value of cells without data in a raster of floats: NaN.
inline constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

/// Criteria for the choice of a band of a raster file.
struct BandCriteria {
  std::string path{};                      ///< path of the file in error messages
  std::optional<int> band{};               ///< band number from 1 that the user selected
  std::vector<std::string_view> words{};   ///< lower-case substrings of the description that select a band
  std::vector<std::string_view> others{};  ///< lower-case substrings of the description that exclude a band
};

/// Returns the number of the band that the user selected, or otherwise of the first band whose description
/// fits, or otherwise of the first band. A choice among several bands is appended to `notes`. @throws
/// InputError for a band that does not exist, or for a colour image without a selected band
int chooseBand(GDALDataset& file, const BandCriteria& wish, std::vector<std::string>& notes);

/// A rectangle of pixels; column and row of its first pixel are counted from the upper left corner of the
/// raster.
struct PixelBox {
  int column = 0;
  int row = 0;
  int width = 0;
  int height = 0;

  friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

/// Returns the values of a band in file order, before any conversion; masked pixels and infinities are NaN.
/// `where` names the file in error messages. @throws InputError with GDAL's message
std::vector<float> readPixels(GDALDataset& raster, int band, const PixelBox& box, const std::string& where);

/// Returns the cells of a box that were overwritten by zeros, found by LostZeros within the box. `nodata` is
/// the no-data value of the band. If `zero_is_ordinary`, 0 is an ordinary value of the layer (see LostZeros).
/// `where` names the file in error messages. @throws InputError
LostCells lostCells(GDALDataset& raster, int band, const PixelBox& box, std::optional<double> nodata,
                    const std::string& where, bool zero_is_ordinary = false);

/// Sets to NaN each value of the pixels `values` of a box that is a lost cell.
void blank(const LostCells& lost, const PixelBox& box, std::vector<float>& values);

/// Returns a message about lost cells. `remedy` is the command-line option to use if 0 is the true value of
/// the cells.
std::string lostNote(const LostCells& lost, const std::string& remedy);

/// Returns a raster in order from south to north of values in order from north to south.
Raster<float> northUp(const Grid& grid, std::vector<float> values);

}  // namespace talus::maps
