#include <cmath>

#include <talus/maps/raster/elevation_reader.hpp>
#include <talus/maps/raster/elevation_values.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>

#include "raster_fixture.hpp"

namespace talus::maps {
namespace elevation_values_test {

using testing::Contains;
using testing::HasSubstr;

TEST(ElevationValues, AppliesScaleOffsetUnitAndIntegerTypes) {
  const TemporaryFolder folder;
  const ElevationMap scaled = readElevation(write(
      {.rows = kHill, .type = GDT_Int16, .nodata = -1, .scale = 0.5, .offset = 100}, folder / "scaled.tif"));
  EXPECT_FLOAT_EQ((scaled.elevation_m[{0, 0}]), 102.5F);
  EXPECT_TRUE(std::isnan(scaled.elevation_m[{3, 2}]));
  const ElevationMap feet = readElevation(write({.rows = kHill, .unit = "ft"}, folder / "feet.tif"));
  EXPECT_FLOAT_EQ((feet.elevation_m[{0, 0}]), 5 * 0.3048F);
  EXPECT_THAT(feet.notes, Contains(HasSubstr("ft converted")));
  const ElevationMap twice = readElevation(folder / "feet.tif", {.vertical_scale = 2});
  EXPECT_FLOAT_EQ((twice.elevation_m[{0, 0}]), 10 * 0.3048F);
}

TEST(ElevationValues, BodyRadiusIsSubtractedFromRadialHeights) {
  const TemporaryFolder folder;
  const std::string path = write({.rows = kHill,
                                  .crs = "IAU_2015:30135",
                                  .transform = std::array<double, 6>{1000, 10, 0, 1000, 0, -10},
                                  .type = GDT_Int16,
                                  .scale = 0.5,
                                  .offset = 1737400},
                                 folder / "ldem.tif");
  EXPECT_FLOAT_EQ((readElevation(path).elevation_m[{0, 0}]), 2.5F);
}

TEST(ElevationValues, UndeclaredNodataValuesAreNoData) {
  const TemporaryFolder folder;
  auto rows = kHill;
  rows[0][0] = -9999;
  const ElevationMap map = readElevation(write({.rows = rows}, folder / "undeclared.tif"));
  EXPECT_TRUE(std::isnan(map.elevation_m[{0, 4}]));
  EXPECT_THAT(map.notes, Contains(HasSubstr("1 cells of -9999 treated as no data")));
  rows[0][0] = -3.4e38;
  EXPECT_TRUE(std::isnan(readElevation(write({.rows = rows}, folder / "huge.tif")).elevation_m[{0, 4}]));
  EXPECT_TRUE(std::isnan(readElevation(folder / "huge.tif", {.nodata = 8}).elevation_m[{3, 0}]));
}

// Closed form: an international foot is 0.3048 m, one of the US survey 1200/3937 m.
TEST(ElevationValues, BandUnitsAreConvertedToMetres) {
  const Dataset raster = memoryRaster(1, 1);
  GDALRasterBand& band = *raster->GetRasterBand(1);
  const auto scale = [&](const char* unit, std::size_t said) {
    band.SetUnitType(unit);
    std::vector<std::string> notes;
    const double out = heightCode(band, 0.0, notes).scale;
    EXPECT_EQ(notes.size(), said) << unit;
    return out;
  };
  EXPECT_EQ(scale("", 0), 1.0);
  EXPECT_EQ(scale("Metre", 0), 1.0);
  EXPECT_EQ(scale("KM", 1), 1000.0);
  EXPECT_EQ(scale("ft", 1), 0.3048);
  EXPECT_EQ(scale("US survey foot", 1), 1200.0 / 3937.0);
  EXPECT_EQ(scale("furlong", 1), 1.0);  // unknown: taken as metres, with a note
}

TEST(ElevationValues, ElevationIsValueTimesScalePlusOffset) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> values{-1, 0, 10, nan, 2e30F};
  std::vector<std::string> notes;
  decodeHeights(values, {.scale = 0.5, .offset_m = 100.0, .nodata = -1.0}, notes);
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_EQ(values[1], 100.0F);
  EXPECT_EQ(values[2], 105.0F);
  EXPECT_TRUE(std::isnan(values[3]));
  EXPECT_TRUE(std::isnan(values[4]));
  EXPECT_TRUE(notes.empty());
}

// Property: a customary no-data value counts as no data only if it is the minimum of all values.
TEST(ElevationValues, NodataMarkerCountsOnlyAsTheMinimumValue) {
  std::vector<std::string> notes;
  std::vector<float> trench{-9999, -10500, 3};
  decodeHeights(trench, {}, notes);
  EXPECT_THAT(trench, testing::ElementsAre(-9999, -10500, 3));
  EXPECT_TRUE(notes.empty());
  std::vector<float> marked{-32768, 12, -32768};
  decodeHeights(marked, {}, notes);
  EXPECT_TRUE(std::isnan(marked[0]) && std::isnan(marked[2]));
  EXPECT_EQ(marked[1], 12.0F);
  EXPECT_THAT(notes, testing::ElementsAre(HasSubstr("2 cells of -32768")));
}

}  // namespace elevation_values_test
}  // namespace talus::maps
