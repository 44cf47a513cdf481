#pragma once

#include <optional>
#include <string>
#include <vector>

class GDALRasterBand;

namespace talus::maps {

/// Conversion of band values to heights [m]: height = value * scale + offset_m.
struct HeightConversion {
  double scale = 1.0;
  double offset_m = 0.0;
  std::optional<double> nodata{};  ///< no-data value of the band, before the conversion
};

/// Conversion by the scale, offset, unit and no-data value that the band states. An offset within 1 % of
/// `body_radius_m` is measured from the centre of the body, and the radius is subtracted. Decisions are added
/// to `notes`.
HeightConversion heightCode(GDALRasterBand& band, double body_radius_m, std::vector<std::string>& notes);

/// Converts values to heights in place. Values equal to the no-data value become NaN; without a stated
/// no-data value, a customary one (such as -9999) is used. Magnitudes above 1e30 become NaN.
void decodeHeights(std::vector<float>& values, const HeightConversion& code, std::vector<std::string>& notes);

}  // namespace talus::maps
