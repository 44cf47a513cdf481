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

/// What a raster of floats holds where a cell has no value.
inline constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

/// Which band of a file to take when the user names none.
struct BandWish {
  std::string path{};                      ///< opens error lines
  std::optional<int> band{};               ///< from 1, as the user selected
  std::vector<std::string_view> words{};   ///< parts of a description that mark the band, in lower case
  std::vector<std::string_view> others{};  ///< parts that rule it out
};

/// The selected band, else the first whose description fits, else the first; a choice among several is said
/// in `notes`. @throws InputError on a band that does not exist, or a picture (colours) when none was asked
/// for
int chooseBand(GDALDataset& file, const BandWish& wish, std::vector<std::string>& notes);

/// Pixels of a raster, from its upper left corner.
struct PixelBox {
  int column = 0;
  int row = 0;
  int width = 0;
  int height = 0;

  friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

/// Reads pixels of a band as they stand into rows of floats, first row first; masked pixels and infinities
/// are NaN. With `overview` above 1 the mean of each overview x overview pixels, of which width and height
/// are multiples, or less than one: from the file's overviews where it has some.
/// @throws InputError with GDAL's words
std::vector<float> readPixels(GDALDataset& raster, int band, const PixelBox& box, const std::string& where,
                              int overview = 1);

/// Cells of a box of a band that were overwritten by zeros, as LostZeros finds them in that box; `nodata`: a value that stands for
/// no data, `zero_is_ordinary` as there. @throws InputError
LostCells lostCells(GDALDataset& raster, int band, const PixelBox& box, std::optional<double> nodata,
                    const std::string& where, bool zero_is_ordinary = false);

/// Makes NaN of the values of a box, in rows of cells of overview x overview pixels, that lost cells reach into.
void blank(const LostCells& lost, const PixelBox& box, int overview, std::vector<float>& values);

/// The line that is said of lost cells; `remedy`: what to do where 0 is their value.
std::string lostNote(const LostCells& lost, const std::string& remedy);

/// Values of a file that begins in the north, as a raster that begins in the south.
Raster<float> northUp(const Grid& grid, std::vector<float> values);

}  // namespace talus::maps
