#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>

#include <cpl_string.h>
#include <gdal_priv.h>

#include <talus/common/input_error.hpp>
#include <talus/common/memory_budget.hpp>
#include <talus/maps/raster/elevation_reader.hpp>
#include <talus/maps/raster/elevation_values.hpp>
#include <talus/maps/raster/numpy_raster.hpp>
#include <talus/maps/raster/raster_band.hpp>
#include <talus/maps/raster/raster_frame.hpp>

namespace talus::maps {
namespace {

void check(const ReadOptions& options) {
  const auto require = [](bool holds, const char* option, const char* bound) {
    if (!holds) throw InputError({option, bound, ""});
  };
  require(!options.resolution_m || (std::isfinite(*options.resolution_m) && *options.resolution_m > 0),
          "--resolution", "must be a number of metres above 0");
  require(!options.resolution_m || (*options.resolution_m >= 1e-3 && *options.resolution_m <= 1e6),
          "--resolution", "must be 0.001 to 1000000 metres");
  require(std::abs(options.vertical_scale) >= 1e-6 && std::abs(options.vertical_scale) <= 1e6,
          "--vertical-scale", "must be 1e-6 to 1e6, or that below 0");
}

// A corner of the window in map coordinates [m].
Point corner(const Place& place, const std::optional<Georeference>& georeference, const std::string& path) {
  if (const auto* point = std::get_if<Point>(&place)) return *point;
  if (georeference) return georeference->forward(std::get<GeoPoint>(place));
  throw InputError({path, "has no CRS for a window in degrees", "give --window in map metres"});
}

// The cells of the grid that the window overlaps.
CellBox cellsOf(const Window& window, const FramedRaster& from, const std::string& path) {
  const Grid& grid = from.grid;
  const Point a = corner(window.first, from.georeference, path);
  const Point b = corner(window.second, from.georeference, path);
  const auto column = [&](double x_m, double up) {
    return std::clamp((x_m - grid.south_west.x_m) / grid.resolution_m + up, 0.0, grid.width + 0.0);
  };
  const auto row = [&](double y_m, double up) {
    return std::clamp((y_m - grid.south_west.y_m) / grid.resolution_m + up, 0.0, grid.height + 0.0);
  };
  // A corner that coincides with a cell edge within 1e-6 cells does not include the next cell.
  constexpr double kRounding = 1e-6;
  const CellBox box{{static_cast<int>(std::floor(column(std::min(a.x_m, b.x_m), kRounding))),
                     static_cast<int>(std::floor(row(std::min(a.y_m, b.y_m), kRounding)))},
                    {static_cast<int>(std::ceil(column(std::max(a.x_m, b.x_m), -kRounding))) - 1,
                     static_cast<int>(std::ceil(row(std::max(a.y_m, b.y_m), -kRounding))) - 1}};
  if (box.width() > 0 && box.height() > 0) return box;
  throw InputError({path, "the window lies outside the map", "it " + extent(grid)});
}

Grid part(const Grid& grid, const CellBox& box) {
  return {.width = box.width(),
          .height = box.height(),
          .resolution_m = grid.resolution_m,
          .south_west = {grid.south_west.x_m + box.first.column * grid.resolution_m,
                         grid.south_west.y_m + box.first.row * grid.resolution_m}};
}

void refuseTooMany(const Grid& grid, const ReadOptions& options, const std::string& path) {
  if (grid.size() <= options.max_cells) return;
  throw InputError({path,
                    std::to_string(grid.width) + " x " + std::to_string(grid.height) + " cells are too many",
                    "read a part with --window or coarser with --resolution, or raise --max-cells"});
}

void refuseSize(const Grid& grid, const ReadOptions& options, const std::string& path) {
  refuseTooMany(grid, options, path);
  if (grid.width < 2 || grid.height < 2)
    throw InputError(
        {path, std::to_string(grid.width) + " x " + std::to_string(grid.height) + " cells have no slope",
         "give a map of at least 2 x 2 cells"});
  constexpr double kFinest_m = 1e-3, kCoarsest_m = 1e6;
  if (!(grid.resolution_m >= kFinest_m && grid.resolution_m <= kCoarsest_m))
    throw InputError({path,
                      "cells of " + std::to_string(grid.resolution_m) + " m; must be 0.001 m to 1000 km",
                      "correct its CRS or --resolution"});
  requireMemory(8.0 * static_cast<double>(grid.size()), path);
}

double radius(GDALDataset& file) {
  const OGRSpatialReference* crs = file.GetSpatialRef();
  return crs == nullptr ? 0.0 : crs->GetSemiMajor();
}

// Pixels to read from a file, their grid and the conversion of their values to heights.
struct Selection {
  FramedRaster from;
  HeightConversion code;
  CellBox box;
  Grid grid;            // grid of the result
  GDALDataset* pixels;  // raster of the file as opened; owned through `from`
  int band;             // band of `pixels`

  bool resampled() const { return from.raster.get() != pixels; }
};

int overviewCells(int cells, int overview) {
  return cells / overview + (cells % overview > 0 ? 1 : 0);
}

Selection select(const std::string& path, const ReadOptions& options, std::vector<std::string>& notes) {
  check(options);
  Dataset file = isNumpyFile(path) ? openNumpyRaster(path, notes) : openRaster(path, options.allow_vrt);
  const int band = chooseBand(*file,
                              {.path = path,
                               .band = options.band,
                               .words = {"elev", "dem", "dtm", "height", "topo", "altitude"},
                               .others = {"slope", "aspect", "shade", "error", "count"}},
                              notes);
  HeightConversion code = heightCode(*file->GetRasterBand(band), radius(*file), notes);
  if (options.nodata) code.nodata = options.nodata;
  code.scale *= options.vertical_scale;
  code.offset_m *= options.vertical_scale;
  GDALDataset* const pixels = file.get();
  FramedRaster from = frame(std::move(file), band, options, path, notes);
  const CellBox whole{{0, 0}, {from.grid.width - 1, from.grid.height - 1}};
  const CellBox box = options.window ? cellsOf(*options.window, from, path) : whole;
  Grid grid = part(from.grid, box);
  grid.width = overviewCells(grid.width, options.overview);
  grid.height = overviewCells(grid.height, options.overview);
  grid.resolution_m *= options.overview;
  return {std::move(from), code, box, grid, pixels, band};
}

// In larger files, only the vicinity of the pixels to read is searched for lost data.
constexpr double kSearchedWhole = 1e8;  // pixels

PixelBox wholeOf(GDALDataset& pixels) {
  return {0, 0, pixels.GetRasterXSize(), pixels.GetRasterYSize()};
}

bool isSearchedWhole(GDALDataset& pixels) {
  return static_cast<double>(pixels.GetRasterXSize()) * pixels.GetRasterYSize() <= kSearchedWhole;
}

// Pixels searched for lost data: the whole file, or the box to read, extended on each side by its own size.
PixelBox searched(const Selection& chosen, const PixelBox& read) {
  const PixelBox whole = wholeOf(*chosen.pixels);
  if (isSearchedWhole(*chosen.pixels)) return whole;
  const int column = std::max(read.column - read.width, 0), row = std::max(read.row - read.height, 0);
  return {column, row,
          static_cast<int>(
              std::min(std::int64_t{whole.width}, std::int64_t{read.column} + 2 * std::int64_t{read.width})) -
              column,
          static_cast<int>(
              std::min(std::int64_t{whole.height}, std::int64_t{read.row} + 2 * std::int64_t{read.height})) -
              row};
}

// Names, sizes and modification times of all files of a raster. All files are listed because the data may
// change while the label does not.
std::string stateOf(GDALDataset& pixels) {
  std::ostringstream state;
  char** files = pixels.GetFileList();
  for (char** file = files; file != nullptr && *file != nullptr; ++file) {
    std::error_code error;
    state << *file << ' ' << std::filesystem::file_size(*file, error) << ' '
          << std::filesystem::last_write_time(*file, error).time_since_epoch().count() << '\n';
  }
  CSLDestroy(files);
  return state.str();
}

// Lost cells in pixels of the file. Caches the last result, because a map that is read in windows opens the
// file for each window.
std::shared_ptr<const LostCells> lostOf(const Selection& chosen, const PixelBox& box,
                                        const std::string& path) {
  struct Known {
    std::string files;
    int band = 0;
    PixelBox box;
    std::optional<double> nodata;
    bool operator==(const Known&) const = default;
  };
  static std::mutex mutex;
  static Known last;
  static std::shared_ptr<const LostCells> lost;
  const Known asked{stateOf(*chosen.pixels), chosen.band, box, chosen.code.nodata};
  const std::lock_guard lock(mutex);
  if (!lost || asked.files.empty() || asked != last) {
    lost = std::make_shared<const LostCells>(
        lostCells(*chosen.pixels, chosen.band, box, chosen.code.nodata, path));
    last = asked;
  }
  return lost;
}

// Rejects a raster with lost cells before resampling, which would mix lost values with the adjacent terrain.
void refuseLostToResample(const Selection& chosen, const std::string& path) {
  if (!isSearchedWhole(*chosen.pixels) || chosen.code.nodata == 0.0) return;
  const auto lost = lostOf(chosen, wholeOf(*chosen.pixels), path);
  if (lost->count > 0)
    throw InputError(
        {path,
         std::to_string(lost->count) +
             " pixels are exactly 0 and what surrounds them does not come down to 0, as where a part "
             "of the file was lost; they cannot be resampled",
         "fetch it again, or pass --nodata 0, or --keep-zeros if 0 is their elevation"});
}

// Reads the pixels of the selection in the row order of the file. An overview cell that the box covers in
// part only, at its northern or eastern edge, is the mean of the covered pixels.
std::vector<float> pixelsOf(const Selection& chosen, const ReadOptions& options, const std::string& path,
                            std::vector<std::string>& notes) {
  const auto& [from, code, box, grid, pixels, band] = chosen;
  const int overview = options.overview;
  const bool may_be_lost = !options.keep_zeros && !chosen.resampled() && code.nodata != 0.0 &&
                           (overview == 1 || isSearchedWhole(*pixels));
  std::shared_ptr<const LostCells> lost;
  std::vector<float> values(grid.size());
  const auto parts = [overview](int cells) {
    const int whole = cells / overview * overview;
    return std::array<std::pair<int, int>, 2>{{{0, whole}, {whole, cells - whole}}};
  };
  for (const auto& [row, rows] : parts(box.height()))
    for (const auto& [column, columns] : parts(box.width())) {
      if (rows == 0 || columns == 0) continue;
      const int south = box.first.row + row;
      const int first_row = from.north_up ? from.grid.height - south - rows : south;
      const PixelBox from_file{box.first.column + column, first_row, columns, rows};
      std::vector<float> part = readPixels(*from.raster, from.band, from_file, path, overview);
      if (may_be_lost && std::ranges::count(part, 0.0F) > 0) {
        lost = lostOf(chosen, searched(chosen, from_file), path);
        blank(*lost, from_file, overview, part);
      }
      const int width = overviewCells(columns, overview), height = overviewCells(rows, overview);
      const int to_row = from.north_up ? grid.height - row / overview - height : row / overview;
      for (int r = 0; r < height; ++r)
        std::copy_n(part.begin() + std::ptrdiff_t{r} * width, width,
                    values.begin() + std::ptrdiff_t{to_row + r} * grid.width + column / overview);
    }
  if (lost && lost->count > 0) notes.push_back(lostNote(*lost, "--keep-zeros"));
  return values;
}

// Limit of |height|: heights are stored in single precision, whose resolution is 1/64 m at 131072 m.
constexpr float kFarthest_m = 131072.0F;

}  // namespace

ElevationMap readElevation(const std::string& path, const ReadOptions& options) {
  const GdalErrors quiet;  // suppresses GDAL's messages about a CRS until the CRS is used
  ElevationMap map;
  map.source = path;
  const Selection chosen = select(path, options, map.notes);
  const auto& [from, code, box, grid, pixels, band] = chosen;
  refuseSize(grid, options, path);
  if (chosen.resampled() && !options.keep_zeros) refuseLostToResample(chosen, path);
  std::vector<float> values = pixelsOf(chosen, options, path, map.notes);
  decodeHeights(values, code, map.notes);
  const auto farthest =
      std::find_if(values.begin(), values.end(), [](float z) { return std::abs(z) > kFarthest_m; });
  if (farthest != values.end())
    throw InputError({path,
                      "holds an elevation of " + std::to_string(*farthest) +
                          " m; beyond 131072 m steps of some centimetres are lost",
                      "take a datum off, as the body's radius, or name the mark of no data by --nodata"});
  map.elevation_m = from.north_up ? northUp(grid, std::move(values)) : Raster<float>(grid, std::move(values));
  map.georeference = from.georeference;
  if (validFraction(map.elevation_m) == 0.0)
    throw InputError({path, "holds no data in any cell" + std::string(options.window ? " of the window" : ""),
                      "check --band, --nodata and --window"});
  return map;
}

Grid elevationGrid(const std::string& path, const ReadOptions& options) {
  const GdalErrors quiet;
  std::vector<std::string> notes;
  const Grid grid = select(path, options, notes).grid;
  refuseTooMany(grid, options, path);
  return grid;
}

}  // namespace talus::maps
