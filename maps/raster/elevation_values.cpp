#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <cpl_minixml.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/complete_file.hpp>
#include <talus/maps/raster/elevation_values.hpp>
#include <talus/maps/raster/file_text.hpp>
#include <talus/maps/raster/raster_band.hpp>

namespace talus::maps {
namespace {

constexpr float kBeyondAnyHeight = 1e30F;
// Limit of |height|: heights are stored in single precision, whose resolution is 1/64 m at 131072 m.
constexpr float kFarthest_m = 131072.0F;

// Length of a unit in lower case [m]; nullopt if it is not known.
std::optional<double> metresOf(std::string_view unit) {
  using Unit = std::pair<std::string_view, double>;
  static constexpr std::array<Unit, 19> known{Unit{"m", 1.0},
                                              Unit{"metre", 1.0},
                                              Unit{"meter", 1.0},
                                              Unit{"km", 1000.0},
                                              Unit{"kilometre", 1000.0},
                                              Unit{"kilometer", 1000.0},
                                              Unit{"dm", 0.1},
                                              Unit{"cm", 0.01},
                                              Unit{"centimetre", 0.01},
                                              Unit{"centimeter", 0.01},
                                              Unit{"mm", 0.001},
                                              Unit{"millimetre", 0.001},
                                              Unit{"millimeter", 0.001},
                                              Unit{"ft", 0.3048},
                                              Unit{"foot", 0.3048},
                                              Unit{"feet", 0.3048},
                                              Unit{"us survey foot", 1200.0 / 3937.0},
                                              Unit{"us survey feet", 1200.0 / 3937.0},
                                              Unit{"ftus", 1200.0 / 3937.0}};
  for (const auto& [name, metres] : known)
    if (unit == name || (unit.size() > 4 && unit.ends_with('s') && unit.substr(0, unit.size() - 1) == name))
      return metres;
  return std::nullopt;
}

bool isNear(double offset, double radius) {
  return radius > 0 && std::abs(offset - radius) < 0.01 * radius;
}

double unitOf(const std::string& stated, double offset, double radius_m, const std::string& path,
              const ReadOptions& options, std::vector<std::string>& notes) {
  const std::optional<double> by_name = metresOf(lower(stated));
  if (!stated.empty() && !by_name && !options.vertical_scale)
    throw InputError({path, "states its heights in '" + stated.substr(0, 40) + "', which is no known unit",
                      "pass --vertical-scale with the metres in that unit"});
  std::optional<double> by_offset;
  if (isNear(offset, radius_m)) by_offset = 1.0;
  if (isNear(offset, radius_m / 1000.0)) by_offset = 1000.0;
  if (by_name && by_offset && *by_name != *by_offset)
    throw InputError({path,
                      "states its heights in '" + stated + "' and their offset as " + number(offset) +
                          ", which is the body's radius in " + (*by_offset == 1.0 ? "metres" : "kilometres"),
                      "correct the unit or the offset with gdal_edit.py"});
  const double unit = by_name.value_or(by_offset.value_or(1.0));
  if (unit != 1.0)
    notes.push_back("heights in " + (by_name ? stated : "kilometres, by their offset,") +
                    " converted to metres");
  return unit;
}

// Adds a special constant or an end of the valid range of a label.
void addConstant(std::string key, const std::string& text, HeightConversion& code) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str()) return;
  key = lower(key);
  if (key == "valid_minimum")
    code.least = value;
  else if (key == "valid_maximum")
    code.greatest = value;
  else
    code.marks.push_back(value);
}

// Adds what a label of PDS3 or PDS4 states and GDAL does not read.
void addLabel(GDALDataset& file, const std::string& path, HeightConversion& code) {
  const std::string_view driver = file.GetDriver() == nullptr ? "" : GDALGetDriverShortName(file.GetDriver());
  if (driver == "PDS")
    for (const char* key : {"MISSING_CONSTANT", "MISSING_CONSTANT_FLAG", "MISSING_VALUE", "MISSING",
                            "INVALID_CONSTANT", "NOT_APPLICABLE_CONSTANT", "UNKNOWN_CONSTANT",
                            "NULL_CONSTANT", "CORE_NULL", "VALID_MINIMUM", "VALID_MAXIMUM"})
      addConstant(key, pds3Keyword(path, key, "IMAGE"), code);
  char** xml = driver == "PDS4" ? file.GetMetadata("xml:PDS4") : nullptr;
  if (xml == nullptr) return;
  const CPLXMLTreeCloser tree(CPLParseXMLString(*xml));
  CPLStripXMLNamespace(tree.get(), nullptr, TRUE);
  const CPLXMLNode* constants = CPLSearchXMLNode(tree.get(), "=Special_Constants");
  for (const CPLXMLNode* one = constants == nullptr ? nullptr : constants->psChild; one != nullptr;
       one = one->psNext)
    addConstant(one->pszValue, CPLGetXMLValue(one, nullptr, ""), code);
}

}  // namespace

HeightConversion heightCode(GDALDataset& file, int band_number, const std::string& path,
                            const ReadOptions& options, std::vector<std::string>& notes) {
  GDALRasterBand& band = *file.GetRasterBand(band_number);
  const OGRSpatialReference* crs = file.GetSpatialRef();
  const double radius_m = crs == nullptr ? 0.0 : crs->GetSemiMajor();
  std::string stated = band.GetUnitType();
  if (stated.empty() && file.GetDriver() != nullptr &&
      GDALGetDriverShortName(file.GetDriver()) == std::string_view("PDS"))
    stated = pds3Keyword(path, "UNIT", "IMAGE");
  const double scale = band.GetScale(), offset = band.GetOffset();
  if (!(std::abs(scale) >= 1e-6 && std::abs(scale) <= 1e6) || !std::isfinite(offset))
    throw InputError({path,
                      "states a scale of " + number(scale) + " and an offset of " + number(offset) +
                          " for its heights; the scale must be 1e-6 to 1e6",
                      "fetch it again, or correct it with gdal_edit.py -scale"});
  const double unit = unitOf(stated, offset, radius_m, path, options, notes);
  HeightConversion code{.scale = scale * unit, .offset_m = offset * unit};
  int declared = FALSE;
  if (const double nodata = band.GetNoDataValue(&declared); declared != FALSE) code.nodata = nodata;
  addLabel(file, path, code);
  if (options.nodata && code.nodata && *options.nodata != *code.nodata)
    notes.push_back("--nodata takes the place of the declared no-data value " + number(*code.nodata));
  if (options.nodata) code.nodata = options.nodata;
  if (isNear(code.offset_m, radius_m)) {
    code.offset_m -= radius_m;
    notes.emplace_back("elevations are measured from the body's centre: radius subtracted");
  }
  code.scale *= options.vertical_scale.value_or(1.0);
  code.offset_m *= options.vertical_scale.value_or(1.0);
  return code;
}

void decodeHeights(std::vector<float>& values, const HeightConversion& code, const std::string& path) {
  std::vector<float> marks(code.marks.begin(), code.marks.end());
  if (code.nodata) marks.push_back(static_cast<float>(*code.nodata));
  for (float& v : values) {
    const bool mark = std::ranges::find(marks, v) != marks.end();
    const auto value = static_cast<double>(v);
    if (mark || value < code.least || value > code.greatest || std::abs(v) > kBeyondAnyHeight) v = kNoValue;
    if (code.scale != 1.0 || code.offset_m != 0.0)
      v = static_cast<float>(static_cast<double>(v) * code.scale + code.offset_m);
  }
  const auto farthest = std::ranges::find_if(values, [](float z) { return std::abs(z) > kFarthest_m; });
  if (farthest != values.end())
    throw InputError({path,
                      "holds an elevation of " + std::to_string(*farthest) +
                          " m; beyond 131072 m steps of some centimetres are lost",
                      "take a datum off, as the body's radius, or name the mark of no data by --nodata"});
}

}  // namespace talus::maps
