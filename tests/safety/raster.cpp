#include "raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>

#include <gdal.h>

namespace safety {
namespace {

constexpr double kNoData = -99999.0;

// Reverses the order of the rows, because the rows of a file run from north to south.
void turnOver(Raster& raster) {
  const auto width = static_cast<std::ptrdiff_t>(raster.width);
  for (std::ptrdiff_t low = 0, high = raster.height - 1; low < high; ++low, --high)
    std::swap_ranges(raster.values.begin() + low * width, raster.values.begin() + (low + 1) * width,
                     raster.values.begin() + high * width);
}

}  // namespace

std::optional<Cell> Raster::cellAt(Place p) const {
  const Cell c{static_cast<int>(std::floor((p.x_m - west_m) / cell_m)),
               static_cast<int>(std::floor((p.y_m - south_m) / cell_m))};
  return holds(c) ? std::optional(c) : std::nullopt;
}

Raster readRaster(const std::string& path) {
  GDALAllRegister();
  const GDALDatasetH file = GDALOpen(path.c_str(), GA_ReadOnly);
  if (!file) throw std::runtime_error(path + ": no raster");
  Raster raster;
  raster.width = GDALGetRasterXSize(file);
  raster.height = GDALGetRasterYSize(file);
  std::array<double, 6> frame{};
  const bool placed =
      GDALGetGeoTransform(file, frame.data()) == CE_None && frame[2] == 0.0 && frame[4] == 0.0;
  const GDALRasterBandH band = GDALGetRasterBand(file, 1);
  raster.values.resize(static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height));
  const bool read = GDALRasterIO(band, GF_Read, 0, 0, raster.width, raster.height, raster.values.data(),
                                 raster.width, raster.height, GDT_Float64, 0, 0) == CE_None;
  int has_no_data = 0;
  const double no_data = GDALGetRasterNoDataValue(band, &has_no_data);
  GDALClose(file);
  if (!placed || !read) throw std::runtime_error(path + ": cannot be read, or is turned");
  raster.cell_m = frame[1];
  raster.west_m = frame[0];
  raster.south_m = frame[3] + frame[5] * raster.height;
  for (double& value : raster.values)
    if (has_no_data && value == no_data) value = std::numeric_limits<double>::quiet_NaN();
  turnOver(raster);
  return raster;
}

void writeAscii(const Raster& raster, const std::string& path) {
  std::ofstream out(path);
  out.precision(9);
  out << "ncols " << raster.width << "\nnrows " << raster.height << "\nxllcorner " << raster.west_m
      << "\nyllcorner " << raster.south_m << "\ncellsize " << raster.cell_m << "\nNODATA_value " << kNoData
      << "\n";
  for (int row = raster.height; row-- > 0; out << "\n")
    for (int column = 0; column < raster.width; ++column) {
      const double value = raster.at({column, row});
      out << (std::isnan(value) ? kNoData : value) << ' ';
    }
  if (!out.flush()) throw std::runtime_error(path + ": cannot be written");
}

Raster part(const Raster& raster, Cell south_west, int width, int height) {
  Raster out{.width = width, .height = height, .cell_m = raster.cell_m, .values = {}};
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      out.values.push_back(raster.at({south_west.column + column, south_west.row + row}));
  return out;
}

}  // namespace safety
