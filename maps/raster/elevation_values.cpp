#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include <gdal_priv.h>

#include <talus/maps/raster/elevation_values.hpp>
#include <talus/maps/raster/raster_band.hpp>

namespace talus::maps {
namespace {

constexpr float kBeyondAnyHeight = 1e30F;

// Length of a unit [m].
double metres(std::string unit, std::vector<std::string>& notes) {
  std::transform(unit.begin(), unit.end(), unit.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  static constexpr std::array<std::pair<const char*, double>, 16> known{{{"", 1.0},
                                                                         {"m", 1.0},
                                                                         {"metre", 1.0},
                                                                         {"metres", 1.0},
                                                                         {"meter", 1.0},
                                                                         {"meters", 1.0},
                                                                         {"km", 1000.0},
                                                                         {"kilometer", 1000.0},
                                                                         {"dm", 0.1},
                                                                         {"cm", 0.01},
                                                                         {"mm", 0.001},
                                                                         {"ft", 0.3048},
                                                                         {"foot", 0.3048},
                                                                         {"feet", 0.3048},
                                                                         {"us survey foot", 1200.0 / 3937.0},
                                                                         {"ftus", 1200.0 / 3937.0}}};
  for (const auto& [name, factor] : known) {
    if (unit != name) continue;
    if (factor != 1.0) notes.push_back("heights in " + unit + " converted to metres");
    return factor;
  }
  notes.push_back("unit of height '" + unit + "' is unknown: assuming metres (--vertical-scale corrects it)");
  return 1.0;
}

// A customary no-data value (-9999, -32768, -32767 or -99999) that equals the least value, if any. Called if
// the file declares no no-data value.
std::optional<float> undeclaredMark(const std::vector<float>& values) {
  float least = std::numeric_limits<float>::infinity();
  for (float v : values)
    if (v < least && v > -kBeyondAnyHeight) least = v;
  for (float mark : {-9999.0F, -32768.0F, -32767.0F, -99999.0F})
    if (least == mark) return mark;
  return std::nullopt;
}

std::size_t blank(std::vector<float>& values, const auto& isMark) {
  std::size_t count = 0;
  for (float& v : values) {
    if (!isMark(v)) continue;
    v = kNoValue;
    ++count;
  }
  return count;
}

void blankMarks(std::vector<float>& values, std::optional<double> nodata, std::vector<std::string>& notes) {
  if (nodata) {
    const auto mark = static_cast<float>(*nodata);
    blank(values, [=](float v) { return v == mark; });
  } else if (const auto mark = undeclaredMark(values)) {
    const std::size_t count = blank(values, [=](float v) { return v == *mark; });
    notes.push_back(std::to_string(count) + " cells of " + std::to_string(static_cast<long>(*mark)) +
                    " treated as no data although the file declares none (--nodata corrects it)");
  }
  blank(values, [](float v) { return std::abs(v) > kBeyondAnyHeight; });
}

}  // namespace

HeightConversion heightCode(GDALRasterBand& band, double body_radius_m, std::vector<std::string>& notes) {
  int stated = FALSE;
  HeightConversion code;
  const double nodata = band.GetNoDataValue(&stated);
  if (stated != FALSE) code.nodata = nodata;
  const double unit = metres(band.GetUnitType(), notes);
  code.scale = band.GetScale() * unit;
  code.offset_m = band.GetOffset() * unit;
  if (body_radius_m > 0 && std::abs(code.offset_m - body_radius_m) < 0.01 * body_radius_m) {
    code.offset_m -= body_radius_m;
    notes.emplace_back("elevations are measured from the body's centre: radius subtracted");
  }
  return code;
}

void decodeHeights(std::vector<float>& values, const HeightConversion& code,
                   std::vector<std::string>& notes) {
  blankMarks(values, code.nodata, notes);
  if (code.scale == 1.0 && code.offset_m == 0.0) return;
  for (float& v : values) v = static_cast<float>(static_cast<double>(v) * code.scale + code.offset_m);
}

}  // namespace talus::maps
