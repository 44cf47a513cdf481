#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <gdal_priv.h>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/complete_file.hpp>
#include <talus/maps/raster/file_text.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/raster_band.hpp>

namespace talus::maps {
namespace {

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

// Sets pixels to NaN that the dataset mask or alpha mask of the band excludes.
void applyMask(GDALRasterBand& band, const PixelBox& box, std::vector<float>& values,
               const std::string& where) {
  if ((band.GetMaskFlags() & (GMF_PER_DATASET | GMF_ALPHA)) == 0) return;
  std::vector<unsigned char> mask(values.size());
  const GdalErrors errors;
  if (band.GetMaskBand()->RasterIO(GF_Read, box.column, box.row, box.width, box.height, mask.data(),
                                   box.width, box.height, GDT_Byte, 0, 0, nullptr) != CE_None)
    throw InputError({where, "its mask cannot be read: " + errors.last(), "fetch it again"});
  for (std::size_t i = 0; i < values.size(); ++i)
    if (mask[i] == 0) values[i] = kNoValue;
}

}  // namespace

int chooseBand(GDALDataset& file, const BandCriteria& wish, std::vector<std::string>& notes) {
  const int count = file.GetRasterCount();
  if (wish.band) {
    if (*wish.band >= 1 && *wish.band <= count) {
      refuseLostBlocks(file, *wish.band, wish.path);
      return *wish.band;
    }
    throw InputError({wish.path + ", band " + std::to_string(*wish.band), "no such band",
                      "it has " + std::to_string(count) + (count == 1 ? " band" : " bands, from 1")});
  }
  int chosen = 1;
  for (int band = count; band >= 1; --band) {
    const std::string name = lower(file.GetRasterBand(band)->GetDescription());
    if (holdsOneOf(name, wish.words) && !holdsOneOf(name, wish.others)) chosen = band;
  }
  if (isPicture(*file.GetRasterBand(chosen)))
    throw InputError({wish.path, "is a colour image without elevations or classes",
                      "select a band with --band if it is intended"});
  refuseLostBlocks(file, chosen, wish.path);
  if (count > 1) notes.push_back("took " + description(file, chosen) + " of " + std::to_string(count));
  return chosen;
}

std::vector<float> readPixels(GDALDataset& raster, int band, const PixelBox& box, const std::string& where) {
  GDALRasterBand& source = *raster.GetRasterBand(band);
  if (GDALDataTypeIsComplex(source.GetRasterDataType()) != FALSE)
    throw InputError({where, "contains complex numbers", "choose a band of real numbers with --band"});
  std::vector<float> values(static_cast<std::size_t>(box.width) * static_cast<std::size_t>(box.height));
  const GdalErrors errors;
  const CPLErr done = source.RasterIO(GF_Read, box.column, box.row, box.width, box.height, values.data(),
                                      box.width, box.height, GDT_Float32, 0, 0, nullptr);
  if (done != CE_None || errors.any())
    throw InputError({where, "cannot be read to its end: " + errors.last(),
                      "the file is damaged or cut short: fetch it again"});
  applyMask(source, box, values, where);
  for (float& v : values)
    if (!std::isfinite(v)) v = kNoValue;
  return values;
}

LostCells lostCells(GDALDataset& raster, int band, const PixelBox& box, std::optional<double> nodata,
                    const std::string& where, bool zero_is_ordinary) {
  constexpr int kCellsAtOnce = 1 << 20;
  const int rows = std::max(1, kCellsAtOnce / box.width);
  LostZeros search(box.width, zero_is_ordinary);
  for (int row = 0; row < box.height; row += rows) {
    const int count = std::min(rows, box.height - row);
    std::vector<float> values =
        readPixels(raster, band, {box.column, box.row + row, box.width, count}, where);
    if (nodata) std::ranges::replace(values, static_cast<float>(*nodata), kNoValue);
    const auto width = static_cast<std::size_t>(box.width);
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
      search.add(std::span(values).subspan(k * width, width));
  }
  LostCells lost = search.finish();
  for (CellRun& run : lost.runs) run = {run.row + box.row, run.first + box.column, run.last + box.column};
  return lost;
}

void blank(const LostCells& lost, const PixelBox& box, std::vector<float>& values) {
  for (const CellRun& run : lost.runs) {
    const int row = run.row - box.row, first = std::max(run.first - box.column, 0),
              last = std::min(run.last - box.column, box.width - 1);
    if (row < 0 || row >= box.height || first > last) continue;
    const auto begin = values.begin() + std::ptrdiff_t{row} * box.width;
    std::fill(begin + first, begin + last + 1, kNoValue);
  }
}

std::string lostNote(const LostCells& lost, const std::string& remedy) {
  return std::to_string(lost.count) +
         " cells of exactly 0 treated as no data: what surrounds them does not come down to 0, as where a "
         "part of the "
         "file was lost (" +
         remedy + " if 0 is their value)";
}

Raster<float> northUp(const Grid& grid, std::vector<float> values) {
  const auto row = [&](int r) { return values.begin() + std::ptrdiff_t{r} * grid.width; };
  for (int r = 0; r < grid.height / 2; ++r) std::swap_ranges(row(r), row(r + 1), row(grid.height - 1 - r));
  return {grid, std::move(values)};
}

}  // namespace talus::maps
