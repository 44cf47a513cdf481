#pragma once

#include <optional>
#include <string>
#include <vector>

class GDALRasterBand;

namespace talus::maps {

/// Linear conversion of the values of a raster band to heights [m]: height = value * scale + offset_m.
struct HeightConversion {
  double scale = 1.0;
  double offset_m = 0.0;
  std::optional<double> nodata{};  ///< band value of cells without data, before the conversion
};

/// Returns the conversion by the scale, offset, unit and no-data value that a band states. If offset_m lies
/// within 1 % of `body_radius_m`, the heights are distances from the centre of the body, and the radius is
/// subtracted. Decisions are appended to `notes`.
HeightConversion heightCode(GDALRasterBand& band, double body_radius_m, std::vector<std::string>& notes);

/// Converts band values to heights [m] in place. Values equal to the no-data value become NaN. Without a
/// no-data value, a customary one (such as -9999) is recognised, which `notes` records. Band values above
/// 1e30 in magnitude become NaN.
void decodeHeights(std::vector<float>& values, const HeightConversion& code, std::vector<std::string>& notes);

}  // namespace talus::maps
