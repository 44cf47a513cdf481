#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <talus/maps/raster/read_options.hpp>

class GDALDataset;

namespace talus::maps {

/// Linear conversion of the values of a raster band to heights [m]: height = value * scale + offset_m.
struct HeightConversion {
  double scale = 1.0;
  double offset_m = 0.0;
  std::optional<double> nodata{};  ///< band value of cells without data, before the conversion
  std::vector<double> marks{};     ///< further such values
  /// Range of the band values of cells with data.
  double least = -std::numeric_limits<double>::infinity(), greatest = std::numeric_limits<double>::infinity();
};

/// Returns the conversion by the scale, offset, unit and no-data value that a band states, and by the options.
/// Of PDS3 and PDS4, the label states the unit, special constants and the valid range. An offset within 1 % of the radius R of the body states metres, one within
/// 1 % of R/1000 kilometres; the heights are then distances from the centre of the body, and R is subtracted.
/// Decisions are appended to `notes`. @throws InputError for an unknown unit, a unit that contradicts the
/// offset, or a scale beyond 1e-6 to 1e6 in magnitude
HeightConversion heightCode(GDALDataset& file, int band, const std::string& path, const ReadOptions& options,
                            std::vector<std::string>& notes);

/// Customary no-data values, which files also use undeclared.
inline constexpr float kCustomaryMarks[] = {-9999.0F, -32768.0F, -32767.0F, -99999.0F};

/// Converts band values to heights [m] in place. Values equal to a no-data value, outside the range of the band,
/// or above 1e30 in magnitude become NaN. @throws InputError for a height beyond 131072 m in magnitude
void decodeHeights(std::vector<float>& values, const HeightConversion& code, const std::string& path);

}  // namespace talus::maps
