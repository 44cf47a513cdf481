#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>
#include <talus/maps/grid/cover.hpp>
#include <talus/maps/maps.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/intake.hpp>
#include <talus/maps/raster/raster_frame.hpp>

namespace talus::maps {
namespace {

bool hasCrs(const OGRSpatialReference* crs) {
  return crs != nullptr && (crs->IsProjected() || crs->IsGeographic());
}

using Affine =
    std::array<double, 6>;  // GDAL's geotransform: x = c[0] + column c[1] + row c[2], y = c[3] + column c[4]
                            // + row c[5]

// Geotransform of a file in map coordinates relative to the south-west corner of the map. A file without a
// CRS and of the size of the map, but of another or no pixel size, is assumed to coincide with the map cell
// by cell.
std::optional<Affine> inMapCoordinates(GDALDataset& file, const Grid& grid) {
  Affine c{};
  const bool stated = file.GetGeoTransform(c.data()) == CE_None;
  const bool same_size = file.GetRasterXSize() == grid.width && file.GetRasterYSize() == grid.height;
  const bool same_cells = stated && std::abs(c[1] - grid.resolution_m) < 1e-6 * grid.resolution_m;
  if (!same_cells && same_size && !hasCrs(file.GetSpatialRef()))
    return Affine{0, grid.resolution_m, 0, grid.height * grid.resolution_m, 0, -grid.resolution_m};
  if (!stated) return std::nullopt;
  c[0] -= grid.south_west.x_m;
  c[3] -= grid.south_west.y_m;
  return c;
}

bool sameSystem(const OGRSpatialReference& crs, const std::string& wkt) {
  OGRSpatialReference other;
  const char* const relaxed[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", nullptr};
  return other.SetFromUserInput(wkt.c_str()) == OGRERR_NONE && crs.IsSame(&other, relaxed) != FALSE;
}

// Copies the values of a band to memory with a margin of one NaN pixel, because values beyond a file are
// unknown. The copy has a CRS only if the CRS differs from that of the map; otherwise its geotransform is relative
// to the south-west corner of the map.
Dataset inMemory(Quantity& quantity, GDALDataset& file, int band, const ElevationMap& map,
                 const std::string& path) {
  const int width = file.GetRasterXSize(), height = file.GetRasterYSize();
  requireMemory(8.0 * (width + 2.0) * (height + 2.0), path);
  Dataset copy(driverNamed("MEM").Create("", width + 2, height + 2, 1, GDT_Float32, nullptr));
  if (!copy) throw InputError({path, "does not fit into memory", "cut it to the map with gdalwarp"});
  const OGRSpatialReference* crs = file.GetSpatialRef();
  const bool elsewhere = hasCrs(crs) && map.georeference && !sameSystem(*crs, map.georeference->system().wkt);
  Affine own{};
  std::optional<Affine> placed =
      elsewhere && file.GetGeoTransform(own.data()) == CE_None ? own : inMapCoordinates(file, map.grid());
  if (placed) {
    Affine& c = *placed;
    c[0] -= c[1] + c[2];
    c[3] -= c[4] + c[5];
    copy->SetGeoTransform(c.data());
  }
  if (elsewhere) copy->SetSpatialRef(crs);
  for (int y = -1; y <= height; ++y) {
    std::vector<float> row(static_cast<std::size_t>(width), kNoValue);
    if (y >= 0 && y < height) row = quantity.of({file, band, {0, y, width, 1}, path});
    row.insert(row.begin(), kNoValue);
    row.push_back(kNoValue);
    if (copy->GetRasterBand(1)->RasterIO(GF_Write, 0, y + 1, width + 2, 1, row.data(), width + 2, 1,
                                         GDT_Float32, 0, 0, nullptr) != CE_None)
      throw InputError({path, "does not fit into memory", "cut it to the map with gdalwarp"});
  }
  return copy;
}

// Number of a layer's band, and its values in memory (inMemory()).
struct LayerBand {
  int number;
  Dataset pixels;
};

LayerBand layerBand(Kind kind, const LayerSource& source, const ElevationMap& map, BandCriteria wish) {
  const Dataset file = openRaster(source.path);
  std::vector<std::string> notes;
  wish.path = source.path;
  wish.band = source.band;
  const int number = chooseBand(*file, wish, notes);
  Quantity quantity(kind, *file, number, source.path);
  return {number, inMemory(quantity, *file, number, map, source.path)};
}

// Pixel corners [m] relative to the south-west corner of the map.
class PixelCorners {
 public:
  PixelCorners(GDALDataset& band, const ElevationMap& map, const std::string& path)
      : corner_(map.grid().south_west) {
    if (band.GetGeoTransform(T_map_pixel_.data()) != CE_None)
      throw InputError({path, "states no place of its pixels", "give it one with gdal_edit.py -a_ullr"});
    if (band.GetSpatialRef() == nullptr) return;
    const std::string target = "DST_SRS=" + map.georeference->system().wkt;
    const char* const options[] = {target.c_str(), nullptr};
    exact_.reset(
        GDALCreateGenImgProjTransformer2(GDALDataset::ToHandle(&band), nullptr, const_cast<char**>(options)));
    if (!exact_)
      throw InputError({path, "cannot be resampled into the map's CRS", "project it with gdalwarp"});
    near_.reset(
        GDALCreateApproxTransformer(GDALGenImgProjTransform, exact_.get(), 1e-3 * map.grid().resolution_m));
  }

  /// Corners along the upper edge of pixel row y; non-finite outside the range of the projection.
  void line(int y, std::vector<Point>& corners) {
    if (!near_) {
      const Affine& c = T_map_pixel_;
      for (std::size_t x = 0; x < corners.size(); ++x) {
        const auto column = static_cast<double>(x);
        corners[x] = {c[0] + column * c[1] + y * c[2], c[3] + column * c[4] + y * c[5]};
      }
      return;
    }
    const std::size_t count = corners.size();
    xs_.resize(count);
    std::iota(xs_.begin(), xs_.end(), 0.0);
    ys_.assign(count, y);
    zs_.assign(count, 0.0);
    reached_.assign(count, 0);
    GDALApproxTransform(near_.get(), FALSE, static_cast<int>(count), xs_.data(), ys_.data(), zs_.data(),
                        reached_.data());
    for (std::size_t x = 0; x < count; ++x)
      corners[x] = reached_[x] != 0 ? Point{xs_[x] - corner_.x_m, ys_[x] - corner_.y_m}
                                    : Point{std::numeric_limits<double>::quiet_NaN(), 0.0};
  }

 private:
  struct Destroy {
    void operator()(void* transformer) const { GDALDestroyTransformer(transformer); }
  };
  Point corner_;
  Affine T_map_pixel_{};
  std::unique_ptr<void, Destroy> exact_, near_;  // the approximate transformer calls the exact one
  std::vector<double> xs_, ys_, zs_;
  std::vector<int> reached_;
};

// Maximum of all pixels that overlap each cell of the map, southernmost row first; NaN without data. GDAL's
// maximum resampling omits pixels of rotated rasters.
Raster<float> greatest(GDALDataset& band, const ElevationMap& map, const std::string& path) {
  PixelCorners corners(band, map, path);
  const int width = band.GetRasterXSize();
  std::vector<float> row(static_cast<std::size_t>(width));
  std::vector<Point> above(row.size() + 1), below(row.size() + 1);
  PixelCover cover(map.grid());
  corners.line(0, below);
  for (int y = 0; y < band.GetRasterYSize(); ++y) {
    std::swap(above, below);
    corners.line(y + 1, below);
    if (band.GetRasterBand(1)->RasterIO(GF_Read, 0, y, width, 1, row.data(), width, 1, GDT_Float32, 0, 0,
                                        nullptr) != CE_None)
      throw InputError({path, "cannot be held in memory", ""});
    for (std::size_t x = 0; x < row.size(); ++x)
      cover.add({above[x], above[x + 1], below[x + 1], below[x]}, row[x]);
  }
  return std::move(cover.values());
}

void requireOverlap(bool overlaps, const ElevationMap& map, const std::string& path) {
  if (!overlaps)
    throw InputError({path, "does not overlap map '" + map.source + "'", "the map " + extent(map.grid())});
}

// Replaces each pixel v of an in-memory band by change(v).
template <class Change>
void changePixels(GDALDataset& band, const std::string& path, Change change) {
  const int width = band.GetRasterXSize();
  std::vector<float> row(static_cast<std::size_t>(width));
  for (int y = 0; y < band.GetRasterYSize(); ++y)
    for (const auto way : {GF_Read, GF_Write}) {
      if (band.GetRasterBand(1)->RasterIO(way, 0, y, width, 1, row.data(), width, 1, GDT_Float32, 0, 0,
                                          nullptr) != CE_None)
        throw InputError({path, "cannot be held in memory", ""});
      if (way == GF_Read) std::ranges::transform(row, row.begin(), change);
    }
}

// Bijection between class numbers and ranks, the weakest class with the greatest rank, so that the maximum
// selects the weakest class. A class missing in `weakest_last` is weaker than all classes of `weakest_last`.
class ClassRanks {
 public:
  explicit ClassRanks(std::span<const int> weakest_last) {
    std::iota(number_of_.begin(), number_of_.end(), std::uint8_t{0});
    std::ranges::stable_sort(number_of_, {}, [&](std::uint8_t number) {
      return std::ranges::find(weakest_last, static_cast<int>(number)) - weakest_last.begin();
    });
    for (std::size_t rank = 0; rank < number_of_.size(); ++rank) rank_of_[number_of_[rank]] = rank;
  }
  float rank(std::uint8_t number) const { return static_cast<float>(rank_of_[number]); }
  std::uint8_t number(float rank) const { return number_of_[static_cast<std::size_t>(rank)]; }

 private:
  std::array<std::uint8_t, 256> number_of_{};
  std::array<std::size_t, 256> rank_of_{};
};

}  // namespace

Raster<std::uint32_t> readImage(const std::string& path, const std::optional<Georeference>& georeference,
                                const Grid& grid) {
  const GdalErrors quiet;
  const Dataset file = openRaster(path);
  if (hasCrs(file->GetSpatialRef()) != georeference.has_value())
    throw InputError(
        {path, "only one of it and the map has a CRS", "give it the map's with gdal_edit.py -a_srs"});
  if (file->GetRasterBand(1)->GetRasterDataType() != GDT_Byte ||
      file->GetRasterBand(1)->GetColorTable() != nullptr)
    throw InputError({path, "is no picture of 8 bits in red, green and blue",
                      "convert it with gdal_translate -expand rgb"});
  const Dataset fitted =
      warp(*file, {.wkt = georeference ? georeference->system().wkt : "", .grid = grid, .method = "average"},
           path);
  Raster<std::uint32_t> image(grid);
  for (const int channel : {0, 1, 2}) {
    const int band = file->GetRasterCount() < 3 ? 1 : channel + 1;
    const std::vector<float> values = Quantity().of({*fitted, band, {0, 0, grid.width, grid.height}, path});
    const Raster<float> placed = northUp(grid, values);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (const float v = placed.values()[i]; !std::isnan(v))
        image.values()[i] |= 0xFF000000U | static_cast<std::uint32_t>(std::lround(v)) << (16 - 8 * channel);
  }
  if (std::ranges::count(image.values(), 0U) == std::ssize(image.values()))
    throw InputError({path, "does not overlap the map", "the map " + extent(grid)});
  return image;
}

Raster<std::uint8_t> readTerrainClasses(const LayerSource& source, const ElevationMap& map,
                                        std::span<const int> weakest_last) {
  const GdalErrors quiet;
  const auto [band, pixels] = layerBand(Kind::Classes, source, map, {.words = {"class"}});
  const ClassRanks ranks(weakest_last);
  const auto ranked = [&, band = band](float v) {
    if (std::isnan(v)) return ranks.rank(kNoClass);
    if (!(v >= 0 && v <= kNoClass) || v != std::floor(v))
      throw InputError({source.path + ", band " + std::to_string(band),
                        "value " + number(static_cast<double>(v)) + " is not a class number (0 to 254)",
                        "name the band of classes"});
    return ranks.rank(static_cast<std::uint8_t>(v));
  };
  changePixels(*pixels, source.path, ranked);
  const Raster<float> weakest = greatest(*pixels, map, source.path);
  Raster<std::uint8_t> classes(map.grid(), kNoClass);
  bool any = false;
  for (std::size_t i = 0; i < weakest.values().size(); ++i)
    if (const float rank = weakest.values()[i]; !std::isnan(rank)) {
      classes.values()[i] = ranks.number(rank);
      any = any || classes.values()[i] != kNoClass;
    }
  requireOverlap(any, map, source.path);
  return classes;
}

AddedJoules readAddedJoules(const LayerSource& source, const ElevationMap& map) {
  const GdalErrors quiet;
  const Dataset band = layerBand(Kind::Added_J_per_m, source, map, {}).pixels;
  AddedJoules added;
  // Unknown and impassable pixels are represented by values beyond any cost, because the maximum ignores NaN.
  constexpr float kMost = 1e6F, kUnknown = 1e38F, kBetween = 2e38F, kRefused = 3e38F;
  const auto marked = [&](float v) {
    if (std::isnan(v)) return kUnknown;
    if (v == std::numeric_limits<float>::infinity()) return kRefused;
    if (!(v >= 0 && v <= kMost))
      throw InputError({source.path, "value " + number(static_cast<double>(v)) + " J/m is not 0 to 1e6",
                        "nothing may make ground cheaper; write inf where the ground is refused"});
    added.highest_J_per_m = std::max(added.highest_J_per_m, v);
    return v;
  };
  changePixels(*band, source.path, marked);
  added.J_per_m = greatest(*band, map, source.path);
  requireOverlap(
      std::ranges::any_of(added.J_per_m.values(), [](float v) { return v <= kMost || v > kBetween; }), map,
      source.path);
  for (float& v : added.J_per_m.values()) {
    if (v > kBetween)
      v = std::numeric_limits<float>::infinity();
    else if (v > kMost)
      v = std::numeric_limits<float>::quiet_NaN();
  }
  return added;
}

RockAbundance readRockAbundance(const LayerSource& source, const ElevationMap& map) {
  const GdalErrors quiet;
  const auto [number_of_band, band] = layerBand(
      Kind::Rocks, source, map, {.words = {"rock", "abundance", "_ra"}, .others = {"slope", "dem"}});
  changePixels(*band, source.path, [&, number_of_band = number_of_band](float v) {
    if (v < 0 || v > 1)
      throw InputError({source.path + ", band " + std::to_string(number_of_band),
                        "rock abundance " + number(static_cast<double>(v)) + " is not a fraction from 0 to 1",
                        v > 1 && v <= 100 ? "divide percents by 100" : "name the band of rock abundance"});
    return v;
  });
  RockAbundance rocks{.share = greatest(*band, map, source.path), .unseen = Raster<std::uint8_t>(map.grid())};
  requireOverlap(std::ranges::any_of(rocks.share.values(), [](float v) { return !std::isnan(v); }), map,
                 source.path);
  changePixels(*band, source.path, [](float v) { return std::isnan(v) ? 1.0F : 0.0F; });
  const Raster<float> unseen = greatest(*band, map, source.path);
  std::ranges::transform(unseen.values(), rocks.unseen.values().begin(), [](float v) { return v != 0.0F; });
  return rocks;
}

}  // namespace talus::maps
