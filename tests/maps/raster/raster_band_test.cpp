#include <cmath>

#include <talus/maps/raster/elevation_reader.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/raster_band.hpp>

#include "raster_fixture.hpp"

namespace talus::maps {
namespace raster_band_test {

using testing::Contains;
using testing::HasSubstr;

TEST(RasterBand, BandNamedLikeElevationIsChosen) {
  const TemporaryFolder folder;
  const std::string path =
      write({.rows = kHill, .names = {"slope of dem", "DEM", "rocks"}}, folder / "stack.tif");
  const ElevationMap map = readElevation(path);
  EXPECT_EQ((map.elevation_m[{0, 0}]), 1005);
  EXPECT_THAT(map.notes, Contains(HasSubstr("took band 2 'DEM' of 3")));
  EXPECT_EQ((readElevation(path, {.band = 3}).elevation_m[{0, 0}]), 2005);
}

// Criteria for an elevation band, as the reader uses them.
BandCriteria wish(const std::string& path, std::optional<int> band = {}) {
  return {.path = path, .band = band, .words = {"elev", "dem"}, .others = {"slope"}};
}

TEST(RasterBand, RequestedBandElseTheFirstIsChosen) {
  const TemporaryFolder folder;
  const std::string path = write({.rows = kHill, .names = {"albedo", "slope of dem"}}, folder / "two.tif");
  const Dataset file = openRaster(path);
  std::vector<std::string> notes;
  EXPECT_EQ(chooseBand(*file, wish(path, 2), notes), 2);
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(chooseBand(*file, wish(path), notes), 1);
  EXPECT_THAT(notes, testing::ElementsAre("took band 1 'albedo' of 2"));
  for (int band : {0, -1, 3})
    EXPECT_THAT(refusal([&] { chooseBand(*file, wish(path, band), notes); }),
                HasSubstr("no such band; it has 2 bands, from 1"));
}

TEST(RasterBand, ColourImageIsRejected) {
  const Dataset picture = memoryRaster(3, 3);
  picture->GetRasterBand(1)->SetColorInterpretation(GCI_RedBand);
  std::vector<std::string> notes;
  EXPECT_THAT(refusal([&] { chooseBand(*picture, wish("photo.png"), notes); }),
              HasSubstr("photo.png: is a colour image"));
  EXPECT_EQ(chooseBand(*picture, wish("photo.png", 1), notes), 1);
}

TEST(RasterBand, PixelsAreReadFirstRowFirst) {
  const TemporaryFolder folder;
  const Dataset file = openRaster(write({.rows = kHill}, folder / "hill.tif"));
  EXPECT_THAT(readPixels(*file, 1, {.column = 1, .row = 0, .width = 2, .height = 2}, "a"),
              testing::ElementsAre(2, 3, 3, 4));
  EXPECT_THAT(refusal([&] { readPixels(*file, 1, {.column = 3, .row = 0, .width = 2, .height = 2}, "a"); }),
              HasSubstr("a: cannot be read to its end"));
}

TEST(RasterBand, MaskedAndInfinitePixelsAreNan) {
  const TemporaryFolder folder;
  auto rows = kHill;
  rows[0][1] = std::numeric_limits<double>::infinity();
  const Dataset file = openRaster(write({.rows = rows}, folder / "masked.tif"));
  const Dataset copy(static_cast<GDALDataset*>(GetGDALDriverManager()->GetDriverByName("MEM")->CreateCopy(
      "", file.get(), FALSE, nullptr, nullptr, nullptr)));
  ASSERT_EQ(copy->CreateMaskBand(GMF_PER_DATASET), CE_None);
  std::vector<unsigned char> mask(20, 255);
  mask[0] = 0;
  ASSERT_EQ(copy->GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, 4, 5, mask.data(), 4, 5, GDT_Byte,
                                                            0, 0, nullptr),
            CE_None);
  const std::vector<float> values = readPixels(*copy, 1, {.width = 4, .height = 5}, "a");
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_TRUE(std::isnan(values[1]));
  EXPECT_EQ(values[2], 3.0F);
}

TEST(RasterBand, NorthUpReversesTheRows) {
  const Grid grid{.width = 2, .height = 3};
  EXPECT_THAT(northUp(grid, {1, 2, 3, 4, 5, 6}).values(), testing::ElementsAre(5, 6, 3, 4, 1, 2));
}

}  // namespace raster_band_test
}  // namespace talus::maps
