#include <filesystem>

#include <talus/maps/raster/gdal_dataset.hpp>

#include "raster_fixture.hpp"

namespace talus::maps {
namespace gdal_dataset_test {

using testing::HasSubstr;

TEST(GdalDataset, OnlyNonEmptyRegularFilesAreReadable) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "inner");
  const auto line = [](const std::string& path) { return refusal([&] { requireReadableFile(path); }); };
  EXPECT_THAT(line(folder / "none"), HasSubstr("none: no such file"));
  EXPECT_THAT(line(folder / "inner"), HasSubstr("is a directory"));
  EXPECT_THAT(line(folder.write("empty", "")), HasSubstr("is empty"));
  EXPECT_EQ(line(folder.write("full", "x")), "accepted");
  EXPECT_THAT(line("/vsimem/whatever"),
              testing::HasSubstr("no such file"));  // GDAL's virtual file systems are excluded
  EXPECT_THAT(line("/dev/zero"), testing::HasSubstr("is a device"));
}

TEST(GdalDataset, OpensRastersAndRejectsOtherFiles) {
  const TemporaryFolder folder;
  const Dataset raster = openRaster(write({.rows = kHill}, folder / "hill.tif"));
  EXPECT_EQ(raster->GetRasterXSize(), 4);
  EXPECT_EQ(raster->GetRasterYSize(), 5);
  EXPECT_THAT(refusal([&] { openRaster(folder.write("text.tif", "no raster")); }),
              HasSubstr("GDAL opens no raster"));
}

// Closed form: 4 x 5 cells of 4 bytes; a file one byte shorter is truncated.
TEST(GdalDataset, TruncatedEnviFileIsRejected) {
  const TemporaryFolder folder;
  const std::string path = write({.rows = kHill, .driver = "ENVI"}, folder / "hill.img");
  EXPECT_EQ(refusal([&] { openRaster(path); }), "accepted");
  std::filesystem::resize_file(path, 79);
  EXPECT_THAT(refusal([&] { openRaster(path); }), HasSubstr("is cut short: 79 of 80 bytes"));
}

TEST(GdalDataset, ErrorsAreCapturedAndNotPrinted) {
  testing::internal::CaptureStderr();
  {
    const GdalErrors errors;
    EXPECT_FALSE(errors.any());
    EXPECT_EQ(errors.last(), "unknown error");
    CPLError(CE_Warning, CPLE_AppDefined, "a warning");
    EXPECT_FALSE(errors.any());
    EXPECT_TRUE(errors.anyWarning());
    CPLError(CE_Failure, CPLE_AppDefined, "first line\nsecond line");
    EXPECT_TRUE(errors.any());
    CPLError(CE_Warning, CPLE_AppDefined, "a later warning");
    EXPECT_EQ(errors.last(), "first line");
    const GdalErrors later;
    EXPECT_FALSE(later.any()) << "counts from its construction";
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(GdalDataset, MemoryRasterIsOneBandOfZeros) {
  const Dataset raster = memoryRaster(3, 2);
  ASSERT_EQ(raster->GetRasterCount(), 1);
  std::array<float, 6> values{1, 1, 1, 1, 1, 1};
  ASSERT_EQ(raster->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 3, 2, values.data(), 3, 2, GDT_Float32, 0, 0,
                                               nullptr),
            CE_None);
  EXPECT_THAT(values, testing::Each(0.0F));
}

// Property: environment variables have no effect; a log file named there would be overwritten, and a cache of
// size 0 would change the order of blocks in a GeoTIFF.
TEST(GdalDataset, EnvironmentVariablesDoNotAffectGdal) {
  registerDrivers();
  for (const char* name : {"CPL_LOG", "CPL_DEBUG", "GDAL_CONFIG_FILE", "GDAL_CACHEMAX"}) {
    ::setenv(name, "victim.txt", 1);
    EXPECT_STRNE(CPLGetConfigOption(name, "unset"), "victim.txt") << name;
    ::unsetenv(name);
  }
}

// Property: without the GTiff driver (GDAL_SKIP=GTiff) writing reports an error instead of ending by a
// signal.
TEST(GdalDataset, MissingDriverIsReported) {
  EXPECT_EQ(std::string(GDALGetDriverShortName(&driverNamed("MEM"))), "MEM");
  EXPECT_THAT(refusal([] { driverNamed("NoSuchDriver"); }), HasSubstr("driver NoSuchDriver: is missing"));
}

}  // namespace gdal_dataset_test
}  // namespace talus::maps
