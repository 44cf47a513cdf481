#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <gdal_alg.h>
#include <gdal_priv.h>

#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/intake.hpp>
#include <talus/maps/raster/raster_frame.hpp>

namespace talus::maps {
namespace {

void check(const ReadOptions& options) {
  const auto require = [](bool holds, const char* option, const char* bound) {
    if (!holds) throw InputError({option, bound, ""});
  };
  require(!options.resolution_m || (*options.resolution_m >= 1e-3 && *options.resolution_m <= 1e6),
          "--resolution", "must be 0.001 to 1000000 metres");
  require(!options.vertical_scale ||
              (std::abs(*options.vertical_scale) >= 1e-6 && std::abs(*options.vertical_scale) <= 1e6),
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
  const auto isDegrees = [](const Place& place) {
    const auto* p = std::get_if<Point>(&place);
    return p != nullptr && std::abs(p->x_m) <= 360.0 && std::abs(p->y_m) <= 360.0;
  };
  const bool degrees = from.georeference && isDegrees(window.first) && isDegrees(window.second);
  throw InputError({path, "the window lies outside the map",
                    "it " + extent(grid) + (degrees ? "; latitudes and longitudes take the suffix d" : "")});
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

// Raster of a file, the cells to read and the grid of the result.
struct Selection {
  Dataset file;
  int band = 1;
  FramedRaster from;
  CellBox box;
  Grid grid;
};

int overviewCells(int cells, int overview) {
  return cells / overview + (cells % overview > 0 ? 1 : 0);
}

Selection select(const std::string& path, const ReadOptions& options, std::vector<std::string>& notes) {
  check(options);
  Dataset file = openRaster(path, options.allow_vrt);
  const int band = chooseBand(*file,
                              {.path = path,
                               .band = options.band,
                               .words = {"elev", "dem", "dtm", "height", "topo", "altitude"},
                               .others = {"slope", "aspect", "shade", "error", "count"}},
                              notes);
  FramedRaster from = frame(*file, options, path, notes);
  const CellBox whole{{0, 0}, {from.grid.width - 1, from.grid.height - 1}};
  const CellBox box = options.window ? cellsOf(*options.window, from, path) : whole;
  Grid grid = part(from.grid, box);
  grid.width = overviewCells(grid.width, options.overview);
  grid.height = overviewCells(grid.height, options.overview);
  grid.resolution_m *= options.overview;
  return {std::move(file), band, std::move(from), box, grid};
}

constexpr double kMostPixels = 1e8;  // that are resampled at once

// Box extended by width and height on each side, within the file.
PixelBox around(const PixelBox& box, int width, int height, GDALDataset& file) {
  const int column = std::max(box.column - width, 0), row = std::max(box.row - height, 0);
  const auto end = [](int first, int count, int margin, int all) {
    return static_cast<int>(std::min(std::int64_t{all}, std::int64_t{first} + count + margin));
  };
  return {column, row, end(box.column, box.width, width, file.GetRasterXSize()) - column,
          end(box.row, box.height, height, file.GetRasterYSize()) - row};
}

// Reads heights [m] from the cells of a file. All checks of values (no-data marks, plausibility)
// are made here, before any mean or resampling mixes the cells.
class HeightReader {
 public:
  HeightReader(const Selection& from, const std::string& path, const ReadOptions& options)
      : heights(Kind::Height_m, *from.file, from.band, path, options),
        file_(*from.file),
        band_(from.band),
        path_(path),
        options_(options) {}

  /// Means of the known among factor x factor pixels of a box, in file order. Blocks at the last column, and at
  /// the first row if `from_below`, else at the last row, have fewer pixels.
  std::vector<float> read(const PixelBox& box, int factor, bool from_below) {
    if (!options_.nodata) {
      eachStrip(box, factor, false, [&](const PixelBox& strip) {
        kept_ = pixels(strip);
        heights.search(kept_);
      });
      heights.found();
    }
    std::vector<float> means;
    eachStrip(box, factor, from_below, [&](const PixelBox& strip) {
      std::vector<float> values = heights.of(pixels(strip));
      if (factor == 1 && means.empty())
        means = std::move(values);
      else
        appendMeans(values, strip, factor, from_below, means);
    });
    return means;
  }

  Quantity heights;

 private:
  // Calls `each` for strips of whole blocks from the first row to the last.
  template <typename Each>
  static void eachStrip(const PixelBox& box, int factor, bool from_below, Each each) {
    constexpr int kPixelsAtOnce = 1 << 24;
    const int usual = factor == 1 ? box.height : std::max(1, kPixelsAtOnce / box.width / factor) * factor;
    const int first = from_below ? usual - factor + (box.height - 1) % factor + 1 : usual;
    for (int row = 0, rows = 0; row < box.height; row += rows) {
      rows = std::min(row == 0 ? first : usual, box.height - row);
      each(PixelBox{box.column, box.row + row, box.width, rows});
    }
  }

  // Pixels of a strip; the last strip is kept until it is asked for again.
  RawPixels pixels(const PixelBox& strip) {
    RawPixels kept = std::exchange(kept_, {});
    return kept.box() == strip ? std::move(kept) : RawPixels(file_, band_, strip, path_);
  }

  static void appendMeans(const std::vector<float>& values, const PixelBox& strip, int factor,
                          bool from_below, std::vector<float>& means) {
    const int width = overviewCells(strip.width, factor), height = overviewCells(strip.height, factor);
    const int above = from_below ? height * factor - strip.height : 0;  // rows missing in the first block
    std::vector<double> sums(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    std::vector<int> counts(sums.size());
    for (int row = 0; row < strip.height; ++row)
      for (int column = 0; column < strip.width; ++column) {
        const float v = values[static_cast<std::size_t>(row) * static_cast<std::size_t>(strip.width) +
                               static_cast<std::size_t>(column)];
        const auto block =
            static_cast<std::size_t>((row + above) / factor) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(column / factor);
        sums[block] += std::isnan(v) ? 0.0 : static_cast<double>(v);
        counts[block] += std::isnan(v) ? 0 : 1;
      }
    for (std::size_t i = 0; i < sums.size(); ++i)
      means.push_back(counts[i] == 0 ? kNoValue : static_cast<float>(sums[i] / counts[i]));
  }

  GDALDataset& file_;
  int band_;
  const std::string& path_;
  const ReadOptions& options_;
  RawPixels kept_{};
};

// Pixels of the file that cover cells of a grid in another frame, with a margin for interpolation.
PixelBox pixelsUnder(const Grid& grid, GDALDataset& file, const Georeference& to, const std::string& path) {
  const std::string target = "DST_SRS=" + to.system().wkt;
  const char* const options[] = {target.c_str(), nullptr};
  const std::unique_ptr<void, decltype(&GDALDestroyTransformer)> transformer(
      GDALCreateGenImgProjTransformer2(GDALDataset::ToHandle(&file), nullptr, const_cast<char**>(options)),
      GDALDestroyTransformer);
  if (!transformer) throw InputError({path, "cannot be brought to metres", "project it with gdalwarp"});
  constexpr int kPlaces = 33, kMarginCells = 4, kMarginPixels = 16;
  double west = 1e300, east = -1e300, north = 1e300, south = -1e300;  // columns and rows
  for (int i = 0; i < kPlaces * kPlaces; ++i) {
    const auto along = [](int k, int cells) {
      return (cells + 2.0 * kMarginCells) * k / (kPlaces - 1) - kMarginCells;
    };
    double x = grid.south_west.x_m + grid.resolution_m * along(i % kPlaces, grid.width);
    double y = grid.south_west.y_m + grid.resolution_m * along(i / kPlaces, grid.height), z = 0.0;
    int reached = 0;
    GDALGenImgProjTransform(transformer.get(), TRUE, 1, &x, &y, &z, &reached);
    if (reached == 0 || !std::isfinite(x) || !std::isfinite(y)) return wholeOf(file);
    west = std::min(west, x), east = std::max(east, x), north = std::min(north, y),
    south = std::max(south, y);
  }
  const PixelBox whole = wholeOf(file);
  const auto at = [](double pixel, int most) {
    return static_cast<int>(std::clamp(std::floor(pixel), 0.0, static_cast<double>(most - 1)));
  };
  const PixelBox box{at(west, whole.width), at(north, whole.height), 1, 1};
  return around(
      {box.column, box.row, at(east, whole.width) - box.column + 1, at(south, whole.height) - box.row + 1},
      kMarginPixels, kMarginPixels, file);
}

// Heights [m] of pixels of a file as a raster in memory in the frame of the file; NaN without data.
Dataset heightsInFrame(HeightReader& reader, GDALDataset& file, PixelBox box, int factor,
                       const std::string& path) {
  box.width -= box.width > factor ? box.width % factor : 0;
  box.height -= box.height > factor ? box.height % factor : 0;
  requireMemory(12.0 * box.width * box.height / factor / factor, path);
  const int width = overviewCells(box.width, factor), height = overviewCells(box.height, factor);
  Dataset raster = memoryRaster(width, height);
  std::array<double, 6> c{};
  file.GetGeoTransform(c.data());
  c[0] += box.column * c[1] + box.row * c[2];
  c[3] += box.column * c[4] + box.row * c[5];
  for (const std::size_t i : {1U, 2U, 4U, 5U}) c[i] *= factor;
  raster->SetGeoTransform(c.data());
  raster->SetSpatialRef(file.GetSpatialRef());
  std::vector<float> heights = reader.read(box, factor, false);
  if (raster->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, width, height, heights.data(), width, height,
                                         GDT_Float32, 0, 0, nullptr) != CE_None)
    throw InputError({path, "does not fit into memory", "read a part with --window"});
  return raster;
}

// Heights of the cells of the result in file order, resampled from the heights of the file.
std::vector<float> resampled(const Selection& chosen, HeightReader& reader, const ReadOptions& options,
                             const std::string& path) {
  const Grid cells = part(chosen.from.grid, chosen.box);
  GDALDataset& file = *chosen.file;
  const PixelBox box =
      options.window ? pixelsUnder(cells, file, *chosen.from.georeference, path) : wholeOf(file);
  // Files too large for memory are reduced first, by a part of the factor that the result asks for.
  const Grid& all = chosen.from.grid;
  const double pixel_m = all.resolution_m * std::sqrt(static_cast<double>(all.size()) /
                                                      file.GetRasterXSize() / file.GetRasterYSize());
  int factor = 1;
  while (static_cast<double>(box.width) * box.height / factor / factor > kMostPixels &&
         cells.resolution_m >= 2.0 * (factor + 1) * pixel_m)
    ++factor;
  const Dataset heights = heightsInFrame(reader, file, box, factor, path);
  const Dataset square = warp(
      *heights,
      {.wkt = chosen.from.georeference->system().wkt, .grid = cells, .method = chosen.from.resampling}, path);
  return Quantity().of({*square, 1, {0, 0, cells.width, cells.height}, path});
}

// Heights of the cells of the file, in file order.
std::vector<float> asStored(const Selection& chosen, HeightReader& reader, const ReadOptions& options) {
  const auto& [file, band, from, box, grid] = chosen;
  const int row = from.north_up ? from.grid.height - 1 - box.last.row : box.first.row;
  return reader.read({box.first.column, row, box.width(), box.height()}, options.overview, from.north_up);
}

// Interpolates single cells without data between opposite neighbours, where the pairs agree: at a step those
// across it and those along it differ.
void fillHoles(Raster<float>& heights, std::vector<std::string>& notes) {
  constexpr double kAgree = 0.25;  // of the cell's side
  constexpr std::array<Cell, 4> kWays{Cell{1, 0}, Cell{0, 1}, Cell{1, 1}, Cell{1, -1}};
  const Grid& grid = heights.grid();
  std::vector<std::pair<Cell, float>> filled;
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      if (!std::isnan(heights[{column, row}])) continue;
      const auto at = [&](int right, int up) {
        const Cell cell{column + right, row + up};
        return grid.contains(cell) ? heights[cell] : kNoValue;
      };
      float low = 0.0F, high = 0.0F, sum = 0.0F;
      int pairs = 0;
      for (const Cell way : kWays) {
        const float mean = 0.5F * (at(way.column, way.row) + at(-way.column, -way.row));
        if (std::isnan(mean)) continue;
        low = pairs == 0 ? mean : std::min(low, mean);
        high = pairs == 0 ? mean : std::max(high, mean);
        sum += mean;
        ++pairs;
      }
      if (pairs >= 3 && static_cast<double>(high - low) <= kAgree * grid.resolution_m)
        filled.emplace_back(Cell{column, row}, sum / static_cast<float>(pairs));
    }
  for (const auto& [cell, height] : filled) heights[cell] = height;
  if (!filled.empty())
    notes.push_back(
        std::to_string(filled.size()) +
        " single cells without data interpolated between neighbours that agree (--keep-holes leaves "
        "them unknown)");
}

}  // namespace

ElevationMap readElevation(const std::string& path, const ReadOptions& options) {
  const GdalErrors quiet;  // suppresses GDAL's messages about a CRS until the CRS is used
  ElevationMap map;
  map.source = path;
  const Selection chosen = select(path, options, map.notes);
  const auto& [file, band, from, box, grid] = chosen;
  refuseSize(grid, options, path);
  map.georeference = from.georeference;
  if (options.frame_only) {
    map.elevation_m = Raster<float>(grid, 0.0F);
    return map;
  }
  HeightReader reader(chosen, path, options);
  std::vector<float> values =
      from.resampling.empty() ? asStored(chosen, reader, options) : resampled(chosen, reader, options, path);
  map.elevation_m = from.north_up ? northUp(grid, std::move(values)) : Raster<float>(grid, std::move(values));
  map.reading = reader.heights.reading();
  map.notes.insert(map.notes.end(), reader.heights.notes.begin(), reader.heights.notes.end());
  if (!options.keep_holes) fillHoles(map.elevation_m, map.notes);
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
