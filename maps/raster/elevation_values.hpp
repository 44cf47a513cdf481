#pragma once

#include <optional>
#include <string>
#include <vector>

class GDALRasterBand;

namespace talus::maps {

/// How the numbers of a band become heights in metres: height = number * scale + offset.
struct HeightCode {
  double scale = 1.0;
  double offset_m = 0.0;
  std::optional<double> nodata{};  ///< as the band has it
};

/// The code that a band states through its scale, offset, unit and nodata value. A band whose offset is about
/// `body_radius_m` counts from the body's centre: the radius is taken off. Decisions go to `notes`.
HeightCode heightCode(GDALRasterBand& band, double body_radius_m, std::vector<std::string>& notes);

/// Turns numbers into heights in place; nodata, and what is clearly an undeclared mark of it, becomes NaN.
void decodeHeights(std::vector<float>& values, const HeightCode& code, std::vector<std::string>& notes);

}  // namespace talus::maps
