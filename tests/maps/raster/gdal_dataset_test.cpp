#include <algorithm>
#include <cmath>
#include <filesystem>

#include <sys/stat.h>

#include <talus/common/common.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/vector/vector_reader.hpp>

#include "layer_fixture.hpp"
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

namespace fs = std::filesystem;

constexpr const char* kForeign = "which is no file of its own folder";

class SourceFiles : public testing::Test {
 protected:
  // Answer to opening a file of the folder as a raster.
  std::string opened(const std::string& name, bool allow_vrt = false) const {
    return refusal([&] { openRaster(folder_ / name, allow_vrt); });
  }
  std::string openedVrt(const std::string& source, const std::string& more = "") const {
    folder_.write("label.vrt",
                  "<VRTDataset rasterXSize=\"4\" rasterYSize=\"5\"><VRTRasterBand dataType=\"Float32\" "
                  "band=\"1\">" +
                      more + "<SimpleSource><SourceFilename relativeToVRT=\"1\">" + source +
                      "</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>");
    return opened("label.vrt", true);
  }

  const TemporaryFolder folder_;
  const TemporaryFolder elsewhere_;
};

TEST_F(SourceFiles, VirtualRasterRequiresPermissionAndPlainNames) {
  write({.rows = kHill}, folder_ / "a.tif");
  EXPECT_EQ(openedVrt("a.tif"), "accepted");
  EXPECT_EQ(openedVrt("<![CDATA[a.tif]]>"), "accepted");
  EXPECT_THAT(opened("label.vrt"),
              HasSubstr("is a virtual raster, which names other files; pass --allow-vrt"));
  const std::string secret = write({.rows = kHill}, elsewhere_ / "secret.tif");
  for (const std::string& source :
       {secret, "../" + fs::path(secret).parent_path().filename().string() + "/secret.tif",
        "<![CDATA[" + secret + "]]>", std::string("/vsicurl/http://127.0.0.1:9/a.tif"),
        std::string("NETCDF:a.nc:z"), std::string("GTIFF_DIR:1:a.tif")})
    EXPECT_THAT(openedVrt(source), HasSubstr(kForeign)) << source;
  folder_.write("code.vrt",
                "<VRTDataset rasterXSize=\"4\" rasterYSize=\"5\"><VRTRasterBand dataType=\"Float32\" "
                "band=\"1\" subClass=\"VRTDerivedRasterBand\"><PixelFunctionType>x"
                "</PixelFunctionType></VRTRasterBand></VRTDataset>");
  EXPECT_THAT(opened("code.vrt", true), HasSubstr("contains code"));
}

TEST_F(SourceFiles, NestedSourcesAreChecked) {
  const std::string secret = write({.rows = kHill}, elsewhere_ / "secret.tif");
  openedVrt(secret);
  fs::rename(folder_ / "label.vrt", folder_ / "inner.vrt");
  EXPECT_THAT(openedVrt("inner.vrt"), HasSubstr(kForeign));
  openedVrt("inner.vrt");
  fs::rename(folder_ / "label.vrt", folder_ / "outer.vrt");
  openedVrt("outer.vrt");
  fs::rename(folder_ / "label.vrt", folder_ / "inner.vrt");
  EXPECT_THAT(opened("inner.vrt", true), HasSubstr("names itself"));
}

TEST_F(SourceFiles, LabelsOutOfTheFolderAreRejected) {
  const std::string numbers(100 * 400, '\0');
  elsewhere_.write("h.img", numbers);
  const auto label = [&](const std::string& name) {
    folder_.write(
        "h.lbl",
        "PDS_VERSION_ID = PDS3\nRECORD_TYPE = FIXED_LENGTH\nRECORD_BYTES = 400\nFILE_RECORDS = 100\n"
        "^IMAGE = \"" +
            name +
            "\"\nOBJECT = IMAGE\nLINES = 100\nLINE_SAMPLES = 100\nSAMPLE_TYPE = PC_REAL\n"
            "SAMPLE_BITS = 32\nEND_OBJECT = IMAGE\nEND\n");
    return opened("h.lbl");
  };
  EXPECT_THAT(label("../" + fs::path(elsewhere_ / "h.img").parent_path().filename().string() + "/h.img"),
              HasSubstr(kForeign));
  fs::create_symlink(elsewhere_ / "h.img", folder_ / "link.img");
  EXPECT_THAT(label("link.img"), HasSubstr(kForeign));
  folder_.write("h.img", numbers);
  EXPECT_EQ(label("h.img"), "accepted");
}

// If the given file is a link, the folder of the target is also allowed.
TEST_F(SourceFiles, LinkedFileMayHaveItsFilesBesideTheTarget) {
  write({.rows = kHill, .driver = "ENVI"}, elsewhere_ / "hill.img");
  fs::create_symlink(elsewhere_ / "hill.img", folder_ / "hill.img");
  fs::create_symlink(elsewhere_ / "hill.hdr", folder_ / "hill.hdr");
  EXPECT_EQ(opened("hill.img"), "accepted");
}

TEST_F(SourceFiles, NeighboursMustBeRegularFiles) {
  write({.rows = kHill}, folder_ / "map.tif");
  for (const char* name : {"map.tif.aux.xml", "map.tif.ovr", "map.tif.msk", "map.prj", "map.TFW"}) {
    ASSERT_EQ(::mkfifo((folder_ / name).c_str(), 0600), 0);
    EXPECT_THAT(opened("map.tif"), HasSubstr("is a device, a FIFO")) << name;
    EXPECT_THAT(refusal([&] { openVector(folder_ / "map.tif"); }), HasSubstr("is a device, a FIFO")) << name;
    fs::remove(folder_ / name);
  }
  EXPECT_EQ(opened("map.tif"), "accepted");
}

// GDAL silently ignores a damaged mask or auxiliary file and would read all pixels as valid.
TEST_F(SourceFiles, SideFileThatGdalDoesNotUseIsRejected) {
  write({.rows = kHill}, folder_ / "map.tif");
  folder_.write("map.tif.msk", std::string("II*\0\x08\0\0\0", 8));
  EXPECT_THAT(opened("map.tif"), HasSubstr("map.tif.msk: belongs to the raster by its name"));
  write({.rows = kHill, .type = GDT_Byte}, folder_ / "map.tif.msk");
  EXPECT_THAT(opened("map.tif"), HasSubstr("map.tif.msk: lacks INTERNAL_MASK_FLAGS"));
  fs::remove(folder_ / "map.tif.msk");
  folder_.write("map.tif.aux.xml", "<PAMDataset><Metadata></PAMDataset>");
  EXPECT_THAT(opened("map.tif"), HasSubstr("map.tif.aux.xml: is no XML"));
}

TEST_F(SourceFiles, AuxiliaryFileMustAgreeWithTheRaster) {
  write({.rows = kHill, .nodata = -1, .scale = 0.5, .unit = "m"}, folder_ / "map.tif");
  const auto with = [&](const std::string& band, const std::string& more = "") {
    folder_.write("map.tif.aux.xml", "<PAMDataset>" + more + "<PAMRasterBand band=\"1\">" + band +
                                         "</PAMRasterBand></PAMDataset>");
    return opened("map.tif");
  };
  EXPECT_EQ(with("<Description>dem</Description><NoDataValue>-1</NoDataValue>"), "accepted");
  EXPECT_EQ(with("<Scale>0.5</Scale><UnitType>m</UnitType>"), "accepted");
  EXPECT_THAT(with("", "<GeoTransform>0, 1, 0, 0, 0, -1</GeoTransform>"),
              HasSubstr("another place than the raster"));
  EXPECT_THAT(with("", "<SRS>EPSG:4326</SRS>"), HasSubstr("another CRS than the raster"));
  // GDAL prefers what the TIFF itself states of its bands.
  for (const char* band : {"<Scale>2</Scale>", "<UnitType>ft</UnitType>", "<NoDataValue>7</NoDataValue>"}) {
    const std::string answer = with(band);
    EXPECT_TRUE(answer != "accepted" || readElevation(folder_ / "map.tif").reading ==
                                            "heights = raw x 0.5 m, unit 'm' (file), no-data -1 (file)")
        << answer;
  }
  fs::remove(folder_ / "map.tif.aux.xml");
  write({.rows = kHill, .driver = "ENVI", .nodata = -1}, folder_ / "map.tif");
  std::ofstream(folder_ / "map.hdr", std::ios::app) << "data gain values = {0.5}\ndata offset values = {7}\n";
  EXPECT_THAT(with("<Scale>2</Scale>"), HasSubstr("another scale than the raster"));
  EXPECT_THAT(with("<Scale>0.5</Scale><Offset>2</Offset>"), HasSubstr("another offset than the raster"));
}

// Property: the manifest holds every file of a raster or vector, and a checksum beside any of them is compared, also
// beside sources and masks.
TEST_F(SourceFiles, ChecksumOfEveryFileIsCompared) {
  if (sha256OfFile("/dev/null").empty()) GTEST_SKIP() << "built without nettle";
  const auto expectAllChecked = [&](const std::string& name, const auto& read) {
    const InputRecord manifest;
    ASSERT_EQ(refusal([&] { read(); }), "accepted") << name;
    std::vector<std::string> beside, listed;
    for (const auto& entry : fs::directory_iterator(fs::path(folder_ / name).parent_path()))
      beside.push_back(entry.path().string());
    for (const InputFile& file : filesRead()) {
      listed.push_back(file.path);
      EXPECT_EQ(file.size, fs::file_size(file.path)) << file.path;
      EXPECT_EQ(file.sha256, sha256OfFile(file.path)) << file.path;
    }
    EXPECT_THAT(listed, testing::UnorderedElementsAreArray(beside));
    for (const std::string& file : beside) {
      folder_.write(fs::path(file).filename().string() + ".sha256", sha256OfFile(file) + "  file\n");
      EXPECT_EQ(refusal([&] { read(); }), "accepted") << file;
      folder_.write(fs::path(file).filename().string() + ".sha256", std::string(64, '0'));
      EXPECT_THAT(refusal([&] { read(); }), HasSubstr(file + ": is not the file of")) << file;
      fs::remove(file + ".sha256");
    }
    for (const std::string& file : beside) fs::remove(file);
  };
  for (const char* driver : {"GTiff", "ENVI", "EHdr", "PDS4", "ISIS3", "AAIGrid"}) {
    const std::string name = std::string("hill") + (driver == std::string("PDS4") ? ".xml" : ".bil");
    write({.rows = kHill, .driver = driver, .nodata = -1}, folder_ / name);
    expectAllChecked(name, [&] { readElevation(folder_ / name, {.resolution_m = 10.0}); });
  }
  write({.rows = kHill}, folder_ / "a.tif");
  openedVrt("a.tif", "<NoDataValue>-1</NoDataValue>");
  expectAllChecked("label.vrt", [&] { openRaster(folder_ / "label.vrt", true); });
}

TEST(GeoTiffWriter, RoundTripIsExact) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  Raster<float> slope(dem.grid(), 0.5F);
  slope[{1, 2}] = std::numeric_limits<float>::quiet_NaN();
  const std::string path = folder / "layers.tif";
  writeGeoTiff({path, &*dem.georeference}, {{"elevation", "m", dem.elevation_m}, {"slope", "", slope}});
  const ElevationMap back = readElevation(path);
  EXPECT_EQ(back.grid(), dem.grid());
  EXPECT_EQ(back.elevation_m.values(), dem.elevation_m.values());
  EXPECT_EQ(back.georeference->system().name, dem.georeference->system().name);
  const ElevationMap second = readElevation(path, {.band = 2});
  EXPECT_TRUE(std::isnan(second.elevation_m[{1, 2}]));
  EXPECT_EQ((second.elevation_m[{0, 0}]), 0.5F);
  Raster<std::uint8_t> classes(dem.grid(), 3);
  classes[{0, 0}] = kNoClass;
  writeGeoTiff({folder / "classes.tif", &*dem.georeference}, "class", classes, kNoClass);
  EXPECT_EQ(drawing(readTerrainClasses({.path = folder / "classes.tif"}, dem)), "3333\n3333\n.333\n");
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(path).parent_path()))
    files += entry.exists() ? 1 : 0;
  EXPECT_EQ(files, 3) << "no file may be left beside";
}

TEST(GeoTiffWriter, InvalidPathOrLayersAreRejected) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  EXPECT_THAT(refusal([&] {
                writeGeoTiff({folder / "no/where.tif"}, {{"z", "m", dem.elevation_m}});
              }),
              HasSubstr("does not exist; make it first"));
  EXPECT_THROW(writeGeoTiff({folder / "a.tif"}, {}), std::invalid_argument);
  EXPECT_THROW(writeGeoTiff({folder / "a.tif"}, {{"z", "m", dem.elevation_m},
                                                 {"s", "", Raster<float>(Grid{.width = 2, .height = 2})}}),
               std::invalid_argument);
}

}  // namespace gdal_dataset_test
}  // namespace talus::maps
