#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include <cpl_string.h>
#include <gdal_priv.h>
#include <gdal_utils.h>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/warp.hpp>

namespace talus::maps {
namespace {

std::string exact(double value) {
  if (std::isnan(value)) return "nan";
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

CPLStringList warpWords(GDALDataset& source, const WarpTarget& target) {
  CPLStringList words;
  const auto add = [&](const auto&... word) { (words.AddString(std::string(word).c_str()), ...); };
  add("-of", "VRT", "-ot", "Float32", "-wt", "Float32", "-dstnodata", "nan", "-et", "0.001", "-r",
      target.method);
  if (!target.wkt.empty()) add("-t_srs", target.wkt);
  if (target.grid) {
    const Grid& g = *target.grid;
    add("-te", exact(g.south_west.x_m), exact(g.south_west.y_m),
        exact(g.south_west.x_m + g.width * g.resolution_m),
        exact(g.south_west.y_m + g.height * g.resolution_m));
    add("-ts", std::to_string(g.width), std::to_string(g.height));
  } else if (target.resolution > 0) {
    add("-tr", exact(target.resolution), exact(target.resolution));
  }
  GDALRasterBand& band = *source.GetRasterBand(1);
  if (int declared = 0; band.GetNoDataValue(&declared),
                        declared == 0 && GDALDataTypeIsFloating(band.GetRasterDataType()) != FALSE)
    add("-srcnodata", "nan");
  return words;
}

}  // namespace

Dataset warp(GDALDataset& source, const WarpTarget& target, const std::string& where) {
  const GdalErrors errors;
  CPLStringList words = warpWords(source, target);
  const std::unique_ptr<GDALWarpAppOptions, decltype(&GDALWarpAppOptionsFree)> options(
      GDALWarpAppOptionsNew(words.List(), nullptr), GDALWarpAppOptionsFree);
  GDALDatasetH input = GDALDataset::ToHandle(&source);
  Dataset out(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &input, options.get(), nullptr)));
  if (!out) throw InputError({where, "cannot be resampled: " + errors.last(), "resample it with gdalwarp"});
  return out;
}

}  // namespace talus::maps
