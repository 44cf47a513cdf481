#include <cmath>

#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/intake.hpp>

#include "raster_fixture.hpp"

namespace talus::maps {
namespace intake_test {

using testing::Contains;
using testing::HasSubstr;

TEST(Intake, AppliesScaleOffsetUnitAndIntegerTypes) {
  const TemporaryFolder folder;
  const ElevationMap scaled = readElevation(write(
      {.rows = kHill, .type = GDT_Int16, .nodata = -1, .scale = 0.5, .offset = 100}, folder / "scaled.tif"));
  EXPECT_FLOAT_EQ((scaled.elevation_m[{0, 0}]), 102.5F);
  EXPECT_TRUE(std::isnan(scaled.elevation_m[{3, 2}]));
  const ElevationMap feet = readElevation(write({.rows = kHill, .unit = "ft"}, folder / "feet.tif"));
  EXPECT_FLOAT_EQ((feet.elevation_m[{0, 0}]), 5 * 0.3048F);
  EXPECT_THAT(feet.notes, Contains(HasSubstr("'ft' (file) converted")));
  const ElevationMap twice = readElevation(folder / "feet.tif", {.vertical_scale = 2});
  EXPECT_FLOAT_EQ((twice.elevation_m[{0, 0}]), 10 * 0.3048F);
}

TEST(Intake, BodyRadiusIsSubtractedFromRadialHeights) {
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

TEST(Intake, UndeclaredNodataValuesAreNoData) {
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

struct Conversion {
  double scale = 0.0, offset_m = 0.0;
};

// The conversion of a band of two cells, 0 and 1, on a body of a radius [m].
Conversion codeOf(const std::string& unit, double offset, double radius_m, std::vector<std::string>& notes,
                  const ReadOptions& options = {}) {
  const Dataset raster = memoryRaster(2, 1);
  OGRSpatialReference crs;
  crs.SetGeogCS("body", "datum", "sphere", radius_m, 0.0);
  raster->SetSpatialRef(&crs);
  GDALRasterBand& band = *raster->GetRasterBand(1);
  band.SetUnitType(unit.c_str());
  band.SetOffset(offset);
  float one = 1.0F;
  EXPECT_EQ(band.RasterIO(GF_Write, 1, 0, 1, 1, &one, 1, 1, GDT_Float32, 0, 0, nullptr), CE_None);
  Quantity heights(Kind::Height_m, *raster, 1, "map.tif", options);
  notes = heights.notes;
  const std::vector<float> at = heights.of({*raster, 1, wholeOf(*raster), "map.tif"});
  return {static_cast<double>(at[1]) - static_cast<double>(at[0]), static_cast<double>(at[0])};
}

// Closed form: an international foot is 0.3048 m, one of the US survey 1200/3937 m.
TEST(Intake, BandUnitsAreConvertedToMetresOrRefused) {
  const auto scale = [&](const char* unit, std::size_t said) {
    std::vector<std::string> notes;
    const double out = codeOf(unit, 0.0, 1737400.0, notes).scale;
    EXPECT_EQ(notes.size(), said) << unit;
    return out;
  };
  EXPECT_EQ(scale("", 0), 1.0);
  EXPECT_EQ(scale("Metre", 0), 1.0);
  EXPECT_EQ(scale("KM", 1), 1000.0);
  for (const char* unit : {"kilometre", "KILOMETERS", "Kilometer"}) EXPECT_EQ(scale(unit, 1), 1000.0) << unit;
  EXPECT_NEAR(scale("ft", 1), 0.3048, 1e-7);  // single precision
  EXPECT_NEAR(scale("US survey foot", 1), 1200.0 / 3937.0, 1e-7);
  std::vector<std::string> notes;
  for (const char* unit : {"yard", "furlong", "kilometr", "ms"})
    EXPECT_THAT(refusal([&] { codeOf(unit, 0.0, 1737400.0, notes); }),
                HasSubstr("which is no known unit; pass --vertical-scale"))
        << unit;
  EXPECT_NEAR(codeOf("yard", 0.0, 1737400.0, notes, {.vertical_scale = 0.9144}).scale, 0.9144, 1e-7);
}

// Property: an offset near the radius, in metres or kilometres, states the unit; a stated unit must agree.
TEST(Intake, OffsetNearTheRadiusSettlesTheUnit) {
  std::vector<std::string> notes;
  for (const char* unit : {"", "km"}) {
    const Conversion code = codeOf(unit, 1737.4, 1737400.0, notes);
    EXPECT_EQ(code.scale, 1000.0);
    EXPECT_NEAR(code.offset_m, 0.0, 1e-6);
  }
  EXPECT_NEAR(codeOf("", 1737410.0, 1737400.0, notes).offset_m, 10.0, 1e-6);
  EXPECT_EQ(codeOf("", 1500.0, 1737400.0, notes).offset_m, 1500.0);
  for (const auto& [unit, offset] : {std::pair{"m", 1737.4}, {"km", 1737400.0}, {"ft", 1737400.0}})
    EXPECT_THAT(refusal([&, unit = unit, offset = offset] { codeOf(unit, offset, 1737400.0, notes); }),
                HasSubstr("which is the body's radius in"));
}

TEST(Intake, ImplausibleScaleIsRefused) {
  const TemporaryFolder folder;
  for (const double scale : {0.0, 1e-9, -1e9})
    EXPECT_THAT(refusal([&] { readElevation(write({.rows = kHill, .scale = scale}, folder / "s.tif")); }),
                HasSubstr("the scale must be 1e-6 to 1e6"))
        << scale;
}

// A label of PDS3 and heights from 0 in steps of 0.001.
std::string pds3(const std::string& unit, const std::string& offset) {
  std::string text =
      "PDS_VERSION_ID = PDS3\r\nRECORD_TYPE = FIXED_LENGTH\r\nRECORD_BYTES = 192\r\nFILE_RECORDS = 16\r\n"
      "LABEL_RECORDS = 4\r\n^IMAGE = 5\r\nOBJECT = TABLE\r\nUNIT = DEGREE\r\nEND_OBJECT = TABLE\r\n"
      "OBJECT = IMAGE\r\nLINES = 12\r\nLINE_SAMPLES = 48\r\nSAMPLE_TYPE = PC_REAL\r\nSAMPLE_BITS = 32\r\n" +
      unit + "OFFSET = " + offset + "\r\nEND_OBJECT = IMAGE\r\nEND\r\n";
  text.resize(768, ' ');
  for (int i = 0; i < 12 * 48; ++i) {
    const auto value = static_cast<float>(0.001 * i);
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  return text;
}

// GDAL reads no unit from labels of PDS3. Closed form: the step from cell to cell is 0.001 units.
TEST(Intake, UnitOfAPds3LabelIsRead) {
  const TemporaryFolder folder;
  const auto step = [&](const std::string& unit) {
    const auto z = readElevation(folder.write("h.img", pds3(unit, "0.0")), {.resolution_m = 5.0}).elevation_m;
    return (z[{1, 0}]) - (z[{0, 0}]);
  };
  EXPECT_NEAR(step("UNIT = KILOMETER\r\n"), 1.0F, 1e-3F);
  EXPECT_NEAR(step("UNIT = \"METER\"\r\n"), 0.001F, 1e-6F);
  EXPECT_NEAR(step(""), 0.001F, 1e-6F);
  EXPECT_THAT(refusal([&] { step("UNIT = PARSEC\r\n"); }), HasSubstr("'PARSEC', which is no known unit"));
}

// Special constants and the valid range of a label are no data; pixels that GDAL reads as other numbers are refused.
TEST(Intake, Pds3LabelIsHonouredOrRefused) {
  const TemporaryFolder folder;
  const auto valid = [&](const std::string& more) {
    return validFraction(
        readElevation(folder.write("h.img", pds3(more, "0.0")), {.resolution_m = 5.0, .keep_holes = true})
            .elevation_m);
  };
  EXPECT_EQ(valid(""), 1.0);
  EXPECT_DOUBLE_EQ(valid("UNKNOWN_CONSTANT = 0.25\r\n"), 1.0 - 1.0 / 576);
  EXPECT_DOUBLE_EQ(valid("VALID_MINIMUM = 0.0995\r\n"), 1.0 - 100.0 / 576);
  // Closed form: 20 m of the sphere of 1737.4 km are 1/1516.17 degrees.
  const std::string scale =
      "A_AXIS_RADIUS = 1737.4 <km>\r\nMAP_SCALE = 20 <METERS/PIXEL>\r\nMAP_RESOLUTION = ";
  EXPECT_EQ(valid(scale + "1516.17 <PIXEL/DEG>\r\n"), 1.0);
  EXPECT_THAT(refusal([&] { valid(scale + "758.1 <PIXEL/DEG>\r\n"); }),
              HasSubstr("pixels per degree that differ"));
  EXPECT_THAT(refusal([&] { valid("LINE_SUFFIX_BYTES = 4\r\n"); }),
              HasSubstr("which GDAL reads as other numbers"));
  std::string integers = pds3("", "0.0");
  integers.replace(integers.find("PC_REAL"), 7, "LSB_INTEGER");
  integers.erase(integers.find("END\r\n") + 5, 4);
  EXPECT_THAT(refusal([&] { readElevation(folder.write("i.img", integers), {.resolution_m = 5.0}); }),
              HasSubstr("holds pixels of SAMPLE_TYPE LSB_INTEGER and SAMPLE_BITS 32"));
}

// Closed form: value = number x scale + offset; the line says so.
TEST(Intake, ElevationIsNumberTimesScalePlusOffset) {
  const TemporaryFolder folder;
  const RasterFile file{
      .rows = {{-1, 0, 10}, {7, 2e30, 7}, {7, 7, 7}}, .nodata = -1.0, .scale = 0.5, .offset = 100.0};
  const ElevationMap map = readElevation(write(file, folder / "s.tif"), {.keep_holes = true});
  EXPECT_TRUE(std::isnan(map.elevation_m[{0, 2}]));
  EXPECT_EQ((map.elevation_m[{1, 2}]), 100.0F);
  EXPECT_EQ((map.elevation_m[{2, 2}]), 105.0F);
  EXPECT_TRUE(std::isnan(map.elevation_m[{1, 1}]));
  EXPECT_EQ(map.reading, "heights = raw x 0.5 + 100 m (unit assumed), no-data -1 (file)");
  EXPECT_THAT(refusal([&] {
                readElevation(write({.rows = {{2e5, 1}, {1, 1}}}, folder / "far.tif"));
              }),
              HasSubstr("beyond 131072 m"));
}

// Radii are heights on cells of 20 m, where their steps of 0.125 m do not show, not on cells of 1 m.
TEST(Intake, RadiiAreHeightsOnWideCells) {
  const TemporaryFolder folder;
  RasterFile file{.rows = {{1737500, 1737501}, {1737502, 1737503}}, .crs = "+proj=eqc +R=1737400"};
  file.transform = std::array<double, 6>{0, 20, 0, 0, 0, -20};
  const ElevationMap map = readElevation(write(file, folder / "radii.tif"));
  EXPECT_EQ((map.elevation_m[{0, 1}]), 100.0F);
  EXPECT_THAT(map.notes, Contains(HasSubstr("elevations are radii")));
  file.transform = std::array<double, 6>{0, 1, 0, 0, 0, -1};
  EXPECT_THAT(refusal([&] { readElevation(write(file, folder / "fine.tif")); }),
              HasSubstr("beyond 131072 m"));
}

// Two statements of a unit must agree: of the band, a vertical CRS (EPSG:6360 is NAVD88 in feet) and Zunits.
TEST(Intake, StatementsOfTheUnitMustAgree) {
  const TemporaryFolder folder;
  const auto stepOf = [&](const std::string& path) {
    const auto z = readElevation(path).elevation_m;
    return (z[{1, 0}]) - (z[{0, 0}]);
  };
  RasterFile file{.rows = kHill, .crs = "EPSG:32610+6360"};
  EXPECT_NEAR(stepOf(write(file, folder / "v.tif")), 1200.0F / 3937.0F, 1e-5F);
  file.unit = "m";
  EXPECT_THAT(refusal([&] { stepOf(write(file, folder / "both.tif")); }),
              HasSubstr("and in 'US survey foot'"));
  const std::string grid = folder.write("z.asc",
                                        "ncols 3\nnrows 3\nxllcorner 500000\nyllcorner 5000000\ncellsize 10\n"
                                        "1 2 3\n1 2 3\n1 2 3\n");
  folder.write("z.prj", "Projection UTM\nZone 10\nDatum WGS84\nUnits METERS\nZunits FEET\nParameters\n");
  EXPECT_NEAR(stepOf(grid), 0.3048F, 1e-5F);
  folder.write("z.prj", "Projection UTM\nZone 10\nDatum WGS84\nUnits METERS\nZunits PARSEC\nParameters\n");
  EXPECT_THAT(refusal([&] { stepOf(grid); }), HasSubstr("'PARSEC', which is no known unit"));
}

// Property: a customary no-data value counts as no data only if it is the minimum of all values.
TEST(Intake, NodataMarkerCountsOnlyAsTheMinimumValue) {
  const TemporaryFolder folder;
  auto rows = kHill;
  rows[0][0] = -9999, rows[1][1] = -10500;
  EXPECT_EQ((readElevation(write({.rows = rows}, folder / "trench.tif")).elevation_m[{0, 4}]), -9999.0F);
  // Beside a declared value, and two of them.
  rows[1][1] = -32768, rows[2][3] = -1;
  const ElevationMap two =
      readElevation(write({.rows = rows, .nodata = -1}, folder / "two.tif"), {.keep_holes = true});
  EXPECT_DOUBLE_EQ(validFraction(two.elevation_m), 17.0 / 20);
  EXPECT_THAT(two.notes,
              testing::IsSupersetOf({HasSubstr("1 cells of -9999"), HasSubstr("1 cells of -32768")}));
}

// Property: a void that the file does not declare is no data in every frame and scale to which the map is
// resampled, and no mean mixes it with ground.
TEST(Intake, UndeclaredVoidIsNoDataInEveryFrame) {
  const TemporaryFolder folder;
  std::vector<std::vector<double>> rows(40, std::vector<double>(40));
  for (std::size_t r = 0; r < 40; ++r)
    for (std::size_t c = 0; c < 40; ++c)
      rows[r][c] = r > 11 && r < 21 && c > 19 && c < 32 ? -32768.0 : 100.0 + 0.5 * static_cast<double>(r + c);
  using Transform = std::array<double, 6>;
  const RasterFile plain{.rows = rows, .type = GDT_Int16};
  RasterFile degrees = plain, oblong = plain, turned = plain, mercator = plain;
  degrees.crs = "EPSG:4326", degrees.transform = Transform{10.0, 2e-4, 0, 46.0, 0, -1.4e-4};
  oblong.transform = Transform{500000, 10, 0, 5000000, 0, -15};
  turned.transform = Transform{500000, 8, 6, 5000000, 6, -8};
  mercator.crs = "EPSG:3857", mercator.transform = Transform{1e6, 10, 0, 6e6, 0, -10};
  const double void_share = 9.0 * 12.0 / 1600.0;
  const auto expectVoid = [&](const RasterFile& file, const ReadOptions& options, double most) {
    const ElevationMap map = readElevation(write(file, folder / "void.tif"), options);
    EXPECT_THAT(map.notes, Contains(HasSubstr("108 cells of -32768 treated as no data"))) << file.crs;
    double least = 1e9, greatest = -1e9, unknown = 0;
    for (const float z : map.elevation_m.values()) {
      unknown += std::isnan(z) ? 1.0 : 0.0;
      if (std::isnan(z)) continue;
      least = std::min(least, static_cast<double>(z)), greatest = std::max(greatest, static_cast<double>(z));
    }
    EXPECT_GT(least, 98.0) << file.crs;
    EXPECT_LT(greatest, 142.0) << file.crs;
    unknown /= static_cast<double>(map.elevation_m.values().size());
    EXPECT_GT(unknown, 0.5 * void_share) << file.crs;
    EXPECT_LT(unknown, most) << file.crs;
  };
  expectVoid(plain, {}, 1.01 * void_share);
  expectVoid(plain, {.overview = 4}, void_share);
  expectVoid(plain, {.resolution_m = 25.0}, void_share);
  expectVoid(plain, {.resolution_m = 7.0}, 2.0 * void_share);
  for (const RasterFile& file : {degrees, oblong, mercator}) expectVoid(file, {}, 2.5 * void_share);
  expectVoid(turned, {}, 0.7);  // half of the square around a turned raster lies outside of it
}

TEST(Intake, BandNamedLikeElevationIsChosen) {
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

TEST(Intake, RequestedBandElseTheFirstIsChosen) {
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

TEST(Intake, ColourImageIsRejected) {
  const Dataset picture = memoryRaster(3, 3);
  picture->GetRasterBand(1)->SetColorInterpretation(GCI_RedBand);
  std::vector<std::string> notes;
  EXPECT_THAT(refusal([&] { chooseBand(*picture, wish("photo.png"), notes); }),
              HasSubstr("photo.png: is a colour image"));
  EXPECT_EQ(chooseBand(*picture, wish("photo.png", 1), notes), 1);
}

TEST(Intake, PixelsAreReadFirstRowFirst) {
  const TemporaryFolder folder;
  const Dataset file = openRaster(write({.rows = kHill}, folder / "hill.tif"));
  EXPECT_THAT(Quantity().of({*file, 1, {.column = 1, .row = 0, .width = 2, .height = 2}, "a"}),
              testing::ElementsAre(2, 3, 3, 4));
  EXPECT_THAT(refusal([&] { RawPixels(*file, 1, {.column = 3, .row = 0, .width = 2, .height = 2}, "a"); }),
              HasSubstr("a: cannot be read to its end"));
}

TEST(Intake, MaskedAndInfinitePixelsAreNan) {
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
  Quantity heights(Kind::Height_m, *copy, 1, "a");
  const std::vector<float> values = heights.of({*copy, 1, wholeOf(*copy), "a"});
  EXPECT_THAT(heights.reading(), HasSubstr(", mask 5 %"));
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_TRUE(std::isnan(values[1]));
  EXPECT_EQ(values[2], 3.0F);
}

TEST(Intake, NorthUpReversesTheRows) {
  const Grid grid{.width = 2, .height = 3};
  EXPECT_THAT(northUp(grid, {1, 2, 3, 4, 5, 6}).values(), testing::ElementsAre(5, 6, 3, 4, 1, 2));
}

}  // namespace intake_test
}  // namespace talus::maps
