#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <utility>

#include <cpl_minixml.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <talus/common/common.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/intake.hpp>

namespace talus::maps {
namespace {

constexpr float kBeyondAnyNumber = 1e30F;
// Limit of |height|: heights are stored in single precision, whose resolution is 1/64 m at 131072 m.
constexpr float kFarthest_m = 131072.0F;

// Customary no-data values, which files also use undeclared.
constexpr std::array<float, 4> kCustomary{-9999.0F, -32768.0F, -32767.0F, -99999.0F};

constexpr Unit kLengths[] = {{"m", 1.0},
                             {"metre", 1.0},
                             {"meter", 1.0},
                             {"km", 1000.0},
                             {"kilometre", 1000.0},
                             {"kilometer", 1000.0},
                             {"dm", 0.1},
                             {"cm", 0.01},
                             {"centimetre", 0.01},
                             {"centimeter", 0.01},
                             {"mm", 0.001},
                             {"millimetre", 0.001},
                             {"millimeter", 0.001},
                             {"ft", 0.3048},
                             {"foot", 0.3048},
                             {"feet", 0.3048},
                             {"us survey foot", 1200.0 / 3937.0},
                             {"us survey feet", 1200.0 / 3937.0},
                             {"ftus", 1200.0 / 3937.0}};
constexpr Unit kFractions[] = {
    {"1", 1.0}, {"fraction", 1.0}, {"%", 0.01}, {"percent", 0.01}, {"per cent", 0.01}};
constexpr Unit kEnergies[] = {{"j/m", 1.0}, {"kj/m", 1000.0}, {"wh/m", 3600.0}, {"wh/km", 3.6}};

// The numbers of a kind of layer. Without `units` a stated unit says nothing.
struct KindOf {
  const char *name, *unit, *remedy;
  std::span<const Unit> units;
};
const KindOf& named(Kind kind) {
  static constexpr KindOf kKinds[] = {
      {"heights", " m", "pass --vertical-scale with the metres in that unit", kLengths},
      {"rock abundance", "", "write fractions from 0 to 1", kFractions},
      {"terrain classes", "", "", {}},
      {"added cost", " J/m", "write joules per metre", kEnergies}};
  return kKinds[static_cast<std::size_t>(kind)];
}

std::optional<double> sizeOf(std::string_view unit, std::span<const Unit> units) {
  for (const auto& [name, size] : units)
    if (unit == name || (unit.size() > 4 && unit.ends_with('s') && unit.substr(0, unit.size() - 1) == name))
      return size;
  return std::nullopt;
}

bool isNear(double offset, double radius) {
  return radius > 0 && std::abs(offset - radius) < 0.01 * radius;
}

// Unit behind Zunits in a side file of an ArcInfo raster, or units in a metre; empty for none.
std::string zUnits(const std::string& path) {
  const std::string unit = wordBehind("zunits", path);
  return lower(unit) == "no" || lower(unit) == "none" ? "" : unit;
}

bool holdsOneOf(const std::string& text, const std::vector<std::string_view>& words) {
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return text.find(word) != text.npos; });
}

std::string description(GDALDataset& file, int band) {
  const std::string words = file.GetRasterBand(band)->GetDescription();
  return "band " + std::to_string(band) + (words.empty() ? "" : " '" + words + "'");
}

bool isPicture(GDALRasterBand& band) {
  const GDALColorInterp colour = band.GetColorInterpretation();
  return colour == GCI_RedBand || colour == GCI_PaletteIndex;
}

}  // namespace

int chooseBand(GDALDataset& file, const BandCriteria& wish, std::vector<std::string>& notes) {
  const int count = file.GetRasterCount();
  int chosen = wish.band.value_or(1);
  if (chosen < 1 || chosen > count)
    throw InputError({wish.path + ", band " + std::to_string(chosen), "no such band",
                      "it has " + std::to_string(count) + (count == 1 ? " band" : " bands, from 1")});
  for (int band = count; band >= 1 && !wish.band; --band) {
    const std::string name = lower(file.GetRasterBand(band)->GetDescription());
    if (holdsOneOf(name, wish.words) && !holdsOneOf(name, wish.others)) chosen = band;
  }
  if (!wish.band && isPicture(*file.GetRasterBand(chosen)))
    throw InputError({wish.path, "is a colour image without elevations or classes",
                      "select a band with --band if it is intended"});
  if (!wish.band && count > 1)
    notes.push_back("took " + description(file, chosen) + " of " + std::to_string(count));
  return chosen;
}

PixelBox wholeOf(GDALDataset& file) {
  return {0, 0, file.GetRasterXSize(), file.GetRasterYSize()};
}

RawPixels::RawPixels(GDALDataset& raster, int band, const PixelBox& box, const std::string& where)
    : box_(box), numbers_(static_cast<std::size_t>(box.width) * static_cast<std::size_t>(box.height)) {
  GDALRasterBand& source = *raster.GetRasterBand(band);
  if (GDALDataTypeIsComplex(source.GetRasterDataType()) != FALSE)
    throw InputError({where, "contains complex numbers", "choose a band of real numbers with --band"});
  const GdalErrors errors;
  const CPLErr done = source.RasterIO(GF_Read, box.column, box.row, box.width, box.height, numbers_.data(),
                                      box.width, box.height, GDT_Float32, 0, 0, nullptr);
  if (done != CE_None || errors.any())
    throw InputError({where, "cannot be read to its end: " + errors.last(),
                      "the file is damaged or cut short: fetch it again"});
  if ((source.GetMaskFlags() & (GMF_PER_DATASET | GMF_ALPHA)) == 0) return;
  std::vector<unsigned char> mask(numbers_.size());
  if (source.GetMaskBand()->RasterIO(GF_Read, box.column, box.row, box.width, box.height, mask.data(),
                                     box.width, box.height, GDT_Byte, 0, 0, nullptr) != CE_None)
    throw InputError({where, "its mask cannot be read: " + errors.last(), "fetch it again"});
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] != 0) continue;
    numbers_[i] = kNoValue;
    ++masked_;
  }
}

Quantity::Quantity(Kind kind, GDALDataset& file, int band_number, const std::string& path,
                   const ReadOptions& options)
    : kind_(kind), path_(path) {
  GDALRasterBand& band = *file.GetRasterBand(band_number);
  const OGRSpatialReference* crs = file.GetSpatialRef();
  const double radius_m = crs == nullptr || kind != Kind::Height_m ? 0.0 : crs->GetSemiMajor();
  radius_m_ = radius_m;
  if (std::array<double, 6> c{}; crs != nullptr && file.GetGeoTransform(c.data()) == CE_None)
    cell_m_ = std::abs(c[1]) * (crs->IsGeographic() != 0 ? kDegree * radius_m : crs->GetLinearUnits());
  const double scale = band.GetScale(), offset = band.GetOffset();
  if (!(std::abs(scale) >= 1e-6 && std::abs(scale) <= 1e6) || !std::isfinite(offset))
    throw InputError({path,
                      "states a scale of " + number(scale) + " and an offset of " + number(offset) +
                          " for its " + named(kind).name + "; the scale must be 1e-6 to 1e6",
                      "fetch it again, or correct it with gdal_edit.py -scale"});
  const double unit = unitOf(statements(file, band), offset, radius_m, options);
  scale_ = scale * unit;
  offset_ = offset * unit;
  int declared = FALSE;
  const double nodata = band.GetNoDataValue(&declared);
  if (int clamped = 0;
      kind == Kind::Height_m && declared != FALSE && !options.nodata &&
      (GDALAdjustValueToDataType(band.GetRasterDataType(), nodata, &clamped, nullptr), clamped != 0))
    throw InputError({path,
                      "states the no-data value " + number(nodata) + ", which its numbers of type " +
                          GDALGetDataTypeName(band.GetRasterDataType()) + " cannot be",
                      "fetch it again; or name the value by --nodata"});
  if (const char* bits = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
      kind == Kind::Height_m && bits != nullptr && GDALDataTypeIsFloating(band.GetRasterDataType()) != FALSE)
    throw InputError({path,
                      std::string("holds heights in floating point of ") + bits +
                          " bits, in steps of up to 1/2048 of them",
                      "fetch it again, or write it in 32 bits"});
  if (options.nodata && declared != FALSE && *options.nodata != nodata)
    notes.push_back("--nodata takes the place of the declared no-data value " + number(nodata));
  if (options.nodata)
    marks_.push_back({static_cast<float>(*options.nodata), "--nodata"});
  else if (declared != FALSE)
    marks_.push_back({static_cast<float>(nodata), "file"});
  takeLabel(file);
  // No other kind of layer has values below 0.
  if (kind != Kind::Height_m)
    for (const float mark : kCustomary) marks_.push_back({mark, ""});
  if (isNear(offset_, radius_m)) {
    offset_ -= radius_m;
    from_ += ", less the body's radius";
    notes.emplace_back("elevations are measured from the body's centre: radius subtracted");
  }
  scale_ *= options.vertical_scale.value_or(1.0);
  offset_ *= options.vertical_scale.value_or(1.0);
  if (options.vertical_scale) from_ += ", --vertical-scale " + number(*options.vertical_scale);
}

std::vector<Quantity::Statement> Quantity::statements(GDALDataset& file, GDALRasterBand& band) const {
  std::vector<Statement> stated{{band.GetUnitType(), "file"}};
  if (driverOf(file) == "PDS") stated.push_back({pds3Keyword(path_, "UNIT", "IMAGE"), "label"});
  if (kind_ == Kind::Height_m) {
    const OGRSpatialReference* crs = file.GetSpatialRef();
    const char* name = nullptr;
    if (crs != nullptr && crs->IsCompound() != 0) {
      crs->GetTargetLinearUnits("VERT_CS", &name);
      stated.push_back({name == nullptr ? "" : name, "vertical CRS"});
    }
    for (const InputFile& side : filesOf(file, path_))
      if (side.role == "CRS" || side.role == "label")
        stated.push_back({zUnits(side.path), std::filesystem::path(side.path).filename().string()});
  }
  std::erase_if(stated, [](const Statement& s) { return s.unit.empty() || s.unit == "unknown"; });
  return stated;
}

double Quantity::unitOf(const std::vector<Statement>& stated, double offset, double radius_m,
                        const ReadOptions& options) {
  std::optional<double> unit;
  for (const auto& [text, where] : stated) {
    std::optional<double> size = sizeOf(lower(text), named(kind_).units);
    char* end = nullptr;
    if (const double in_a_metre = std::strtod(text.c_str(), &end); *end == '\0' && in_a_metre > 0.0)
      size = 1.0 / in_a_metre;
    if (named(kind_).units.empty() || (!size && options.vertical_scale)) continue;
    if (!size)
      throw InputError({path_,
                        std::string("states its ") + named(kind_).name + " in '" + text.substr(0, 40) +
                            "', which is no known unit",
                        named(kind_).remedy});
    if (unit && std::abs(*unit - *size) > 1e-9 * *size)
      throw InputError({path_,
                        std::string("states its ") + named(kind_).name + " in " + from_ + " and in '" + text +
                            "' (" + where + ")",
                        "correct one of them with gdal_edit.py"});
    if (!unit) from_ = "'" + text + "' (" + where + ")";
    unit = size;
  }
  std::optional<double> by_offset;
  if (isNear(offset, radius_m)) by_offset = 1.0;
  if (isNear(offset, radius_m / 1000.0)) by_offset = 1000.0;
  if (unit && by_offset && *unit != *by_offset)
    throw InputError({path_,
                      "states its heights in " + from_ + " and their offset as " + number(offset) +
                          ", which is the body's radius in " + (*by_offset == 1.0 ? "metres" : "kilometres"),
                      "correct the unit or the offset with gdal_edit.py"});
  if (!unit && by_offset)
    from_ = *by_offset == 1.0 ? "metres, by their offset" : "kilometres, by their offset";
  const double size = unit.value_or(by_offset.value_or(1.0));
  if (size != 1.0) notes.push_back(std::string(named(kind_).name) + " in " + from_ + " converted");
  return size;
}

// Takes what a label of PDS3 or PDS4 states and GDAL does not read.
void Quantity::takeLabel(GDALDataset& file) {
  if (driverOf(file) == "PDS")
    for (const char* key : {"MISSING_CONSTANT", "MISSING_CONSTANT_FLAG", "MISSING_VALUE", "MISSING",
                            "INVALID_CONSTANT", "NOT_APPLICABLE_CONSTANT", "UNKNOWN_CONSTANT",
                            "NULL_CONSTANT", "CORE_NULL", "VALID_MINIMUM", "VALID_MAXIMUM"})
      takeConstant(key, pds3Keyword(path_, key, "IMAGE"));
  char** xml = driverOf(file) == "PDS4" ? file.GetMetadata("xml:PDS4") : nullptr;
  if (xml == nullptr) return;
  const CPLXMLTreeCloser tree(CPLParseXMLString(*xml));
  CPLStripXMLNamespace(tree.get(), nullptr, TRUE);
  const CPLXMLNode* constants = CPLSearchXMLNode(tree.get(), "=Special_Constants");
  for (const CPLXMLNode* one = constants == nullptr ? nullptr : constants->psChild; one != nullptr;
       one = one->psNext)
    takeConstant(one->pszValue, CPLGetXMLValue(one, nullptr, ""));
}

// Takes a special constant or an end of the valid range of a label.
void Quantity::takeConstant(std::string key, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str()) return;
  key = lower(key);
  if (key == "valid_minimum")
    least_ = value;
  else if (key == "valid_maximum")
    greatest_ = value;
  else
    marks_.push_back({static_cast<float>(value), "label"});
}

bool Quantity::isMark(float value) const {
  return std::ranges::find(marks_, value, &Mark::number) != marks_.end();
}

void Quantity::search(const RawPixels& pixels) {
  for (const float v : pixels.numbers_) {
    if (!(v >= -kBeyondAnyNumber)) continue;
    const auto mark = std::ranges::find(kCustomary, v);
    if (mark == kCustomary.end())
      lowest_ = std::min(lowest_, v),
      highest_ = std::max(highest_, v < kBeyondAnyNumber && !isMark(v) ? v : lowest_);
    else
      ++customary_[static_cast<std::size_t>(mark - kCustomary.begin())];
  }
}

void Quantity::found() {
  for (std::size_t i = 0; i < kCustomary.size(); ++i) {
    if (customary_[i] == 0 || kCustomary[i] >= lowest_ || isMark(kCustomary[i])) continue;
    marks_.push_back({kCustomary[i], "found"});
    notes.push_back(std::to_string(customary_[i]) + " cells of " +
                    number(static_cast<double>(kCustomary[i])) +
                    " treated as no data although the file does not declare it (--nodata corrects it)");
  }
  // Radii: single precision stores them in steps of up to 0.25 m, which fine cells would show as slopes.
  constexpr double kStep_m = 0.25, kFewest = 50.0;
  const auto height = [&](float raw) { return static_cast<double>(raw) * scale_ + offset_; };
  if (isNear(height(lowest_), radius_m_) && isNear(height(highest_), radius_m_) &&
      cell_m_ >= kFewest * kStep_m) {
    offset_ -= radius_m_;
    from_ += ", less the body's radius";
    notes.emplace_back("elevations are radii: the body's radius subtracted; steps of up to 0.25 m");
  }
}

std::vector<float> Quantity::of(RawPixels pixels) {
  masked_ += pixels.masked_;
  read_ += pixels.numbers_.size();
  for (float& v : pixels.numbers_) {
    const auto value = static_cast<double>(v);
    const bool unbounded = kind_ == Kind::Added_J_per_m && std::isinf(v);
    if (isMark(v) || value < least_ || value > greatest_ || (std::abs(v) > kBeyondAnyNumber && !unbounded))
      v = kNoValue;
    if (scale_ != 1.0 || offset_ != 0.0) v = static_cast<float>(static_cast<double>(v) * scale_ + offset_);
  }
  const auto farthest =
      std::ranges::find_if(pixels.numbers_, [](float z) { return std::abs(z) > kFarthest_m; });
  if (kind_ == Kind::Height_m && farthest != pixels.numbers_.end())
    throw InputError({path_,
                      "holds an elevation of " + std::to_string(*farthest) +
                          " m; beyond 131072 m steps of some centimetres are lost",
                      "take a datum off, as the body's radius, or name the mark of no data by --nodata"});
  return std::move(pixels.numbers_);
}

std::string Quantity::reading() const {
  std::string text = std::string(named(kind_).name) + " = raw";
  if (scale_ != 1.0) text += " x " + number(scale_);
  if (offset_ != 0.0) text += (offset_ < 0.0 ? " - " : " + ") + number(std::abs(offset_));
  text += named(kind_).unit;
  text += from_.empty() || from_.starts_with(',') ? " (unit assumed)" + from_ : ", unit " + from_;
  for (const auto& [mark, how] : marks_)
    if (*how != '\0') text += ", no-data " + number(static_cast<double>(mark)) + " (" + how + ")";
  if (masked_ > 0)
    text += ", mask " +
            number(std::round(1000.0 * static_cast<double>(masked_) / static_cast<double>(read_)) / 10.0) +
            " %";
  return text;
}

Raster<float> northUp(const Grid& grid, std::vector<float> values) {
  const auto row = [&](int r) { return values.begin() + std::ptrdiff_t{r} * grid.width; };
  for (int r = 0; r < grid.height / 2; ++r) std::swap_ranges(row(r), row(r + 1), row(grid.height - 1 - r));
  return {grid, std::move(values)};
}

}  // namespace talus::maps
