#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <talus/maps/gdal_dataset.hpp>
#include <talus/maps/referenced_files.hpp>
#include <talus/talus.hpp>

namespace talus::maps {
namespace {

namespace fs = std::filesystem;

class ReferencedFiles : public testing::Test {
 protected:
  ReferencedFiles() : path_(fs::temp_directory_path() / ("talus-label" + std::to_string(::getpid()))) {}
  ~ReferencedFiles() override { fs::remove(path_); }

  std::string said(const std::string& text, bool allow_vrt = false) const {
    std::ofstream(path_, std::ios::binary) << text;
    try {
      refuseForeignReferences(path_.string(), allow_vrt);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }

  const fs::path path_;
};

std::string virtualRaster(const std::string& source, const std::string& more = "") {
  return "<VRTDataset rasterXSize=\"20\" rasterYSize=\"20\"><VRTRasterBand dataType=\"Byte\" band=\"1\">" +
         more + "<SimpleSource><SourceFilename relativeToVRT=\"1\">" + source +
         "</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>";
}

TEST_F(ReferencedFiles, AVirtualRasterNeedsLeave) {
  EXPECT_THAT(said(virtualRaster("a.tif")), testing::HasSubstr("--allow-vrt"));
  EXPECT_EQ(said(virtualRaster("a.tif"), true), "");
}

TEST_F(ReferencedFiles, NothingLeavesTheFolder) {
  for (const char* source : {"/etc/passwd", "../a.tif", "..", "sub/a.tif", "/vsicurl/http://127.0.0.1/a.tif",
                             "http://127.0.0.1/a.tif", "NETCDF:a.nc:z", "C:\\a.tif", "&#47;etc&#47;passwd"}) {
    EXPECT_THAT(said(virtualRaster(source), true), testing::HasSubstr("no file of its own folder")) << source;
    EXPECT_NE(said("<?xml version=\"1.0\"?><Product_Observational><File><file_name>" + std::string(source) +
                   "</file_name></File></Product_Observational>"),
              "")
        << source;
    EXPECT_NE(said("Object = IsisCube\n  ^Core = \"" + std::string(source) + "\"\n"), "") << source;
    EXPECT_NE(said("PDS_VERSION_ID = PDS3\n^IMAGE = (\"" + std::string(source) + "\", 3)\n"), "") << source;
  }
  EXPECT_THAT(said(virtualRaster("a.tif", "<PixelFunctionType>x</PixelFunctionType>"), true),
              testing::HasSubstr("code"));
  // A raw band names its file, too.
  EXPECT_NE(said("<VRTDataset><VRTRasterBand subClass=\"VRTRawRasterBand\"><SourceFilename>/etc/passwd"
                 "</SourceFilename></VRTRasterBand></VRTDataset>",
                 true),
            "");
}

TEST_F(ReferencedFiles, PlainNamesAndOtherFilesPass) {
  EXPECT_EQ(said("<Product_Observational><file_name>image.img</file_name></Product_Observational>"), "");
  EXPECT_EQ(said("Object = IsisCube\n  ^Core = core.cub\n"), "");
  EXPECT_EQ(said("PDS_VERSION_ID = PDS3\n^IMAGE = (\"IMAGE.IMG\", 3 <BYTES>)\n"), "");
  EXPECT_EQ(said("ncols 2\nnrows 2\n"), "");
  EXPECT_EQ(said(std::string("II*\0\x08", 5)), "");
}

// A GeoTIFF that is none, which GDAL by itself would follow.
TEST_F(ReferencedFiles, OpeningFollowsNone) {
  std::ofstream(path_, std::ios::binary) << virtualRaster("/etc/passwd");
  EXPECT_THROW(openRaster(path_.string()), InputError);
  EXPECT_THROW(openRaster(path_.string(), true), InputError);
  EXPECT_THROW(openRaster("/vsicurl/http://127.0.0.1:9/a.tif"), InputError);
}

}  // namespace
}  // namespace talus::maps
