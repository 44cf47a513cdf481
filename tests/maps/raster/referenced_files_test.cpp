#include <filesystem>

#include <refused.hpp>
#include <sys/stat.h>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/maps/raster/referenced_files.hpp>

#include "raster_fixture.hpp"

namespace talus::maps {
namespace referenced_files_test {

using testing::HasSubstr;

namespace fs = std::filesystem;

class ReferencedFiles : public testing::Test {
 protected:
  std::string said(const std::string& text, bool allow_vrt = false) const {
    folder_.write("label", text);
    return checked("label", allow_vrt);
  }

  std::string checked(const std::string& name, bool allow_vrt = false) const {
    try {
      refuseForeignReferences(folder_ / name, allow_vrt);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }

  const TemporaryFolder folder_;
  const TemporaryFolder elsewhere_;
};

std::string virtualRaster(const std::string& source, const std::string& more = "") {
  return "<VRTDataset rasterXSize=\"20\" rasterYSize=\"20\"><VRTRasterBand dataType=\"Byte\" band=\"1\">" +
         more + "<SimpleSource><SourceFilename relativeToVRT=\"1\">" + source +
         "</SourceFilename></SimpleSource></VRTRasterBand></VRTDataset>";
}

TEST_F(ReferencedFiles, VirtualRasterRequiresPermission) {
  EXPECT_THAT(said(virtualRaster("a.tif")), testing::HasSubstr("--allow-vrt"));
  EXPECT_EQ(said(virtualRaster("a.tif"), true), "");
}

TEST_F(ReferencedFiles, ReferencesOutsideTheFolderAreRejected) {
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
  // A raw band refers to a file as well.
  EXPECT_NE(said("<VRTDataset><VRTRasterBand subClass=\"VRTRawRasterBand\"><SourceFilename>/etc/passwd"
                 "</SourceFilename></VRTRasterBand></VRTDataset>",
                 true),
            "");
}

TEST_F(ReferencedFiles, PlainNamesAndOtherFilesAreAccepted) {
  EXPECT_EQ(said("<Product_Observational><file_name>image.img</file_name></Product_Observational>"), "");
  EXPECT_EQ(said("Object = IsisCube\n  ^Core = core.cub\n"), "");
  EXPECT_EQ(said("PDS_VERSION_ID = PDS3\n^IMAGE = (\"IMAGE.IMG\", 3 <BYTES>)\n"), "");
  EXPECT_EQ(said("ncols 2\nnrows 2\n"), "");
  EXPECT_EQ(said(std::string("II*\0\x08", 5)), "");
}

// Property: a virtual raster with another file name is rejected, although GDAL would open the file.
TEST_F(ReferencedFiles, OpeningChecksReferencesOfVirtualRasters) {
  const std::string path = folder_.write("label", virtualRaster("/etc/passwd"));
  EXPECT_REFUSED(openRaster(path), InputError,
                 "is a virtual raster, which names other files; pass --allow-vrt");
  EXPECT_REFUSED(openRaster(path, true), InputError,
                 "names '/etc/passwd', which is no file of its own folder");
  EXPECT_REFUSED(openRaster("/vsicurl/http://127.0.0.1:9/a.tif"), InputError,
                 "/vsicurl/http://127.0.0.1:9/a.tif: no such file");
}

// Property: references are detected in all notations of a text in XML, and with all separations between a
// keyword and its value.
TEST_F(ReferencedFiles, EscapedReferencesAreDetected) {
  for (const char* source : {"<![CDATA[/etc/passwd]]>", "<!-- a -->/etc/passwd", " \n/etc/passwd"}) {
    EXPECT_THAT(said(virtualRaster(source), true), HasSubstr("no file of its own folder")) << source;
    EXPECT_THAT(said("<?xml version=\"1.0\"?><!--" + std::string(5000, ' ') +
                     "--><p:Product_Observational><p:file_name>" + source +
                     "</p:file_name></p:Product_Observational>"),
                HasSubstr("no file of its own folder"))
        << source;
  }
  for (const char* pointer : {"^IMAGE =\n /etc/passwd\n", "^IMAGE /*=*/ = \"/etc/passwd\"\n",
                              "^IMAGE = (\"a)\", \"/etc/passwd\")\n", "^IMAGE = (\n1,\n'/etc/passwd')\n"})
    EXPECT_THAT(said("PDS_VERSION_ID = PDS3\n" + std::string(pointer)), HasSubstr("own folder")) << pointer;
  EXPECT_THAT(said("<VRTDataset><Metadata domain=\"GEOLOCATION\"><MDI key=\"X_DATASET\">/etc/passwd</MDI>"
                   "</Metadata></VRTDataset>",
                   true),
              HasSubstr("own folder"));
  // An image may follow the label; its bytes are no references.
  EXPECT_EQ(said("PDS_VERSION_ID = PDS3\n^IMAGE = 3\nEND\n" + std::string(600, ' ') + "^A = /etc/passwd"),
            "");
}

TEST_F(ReferencedFiles, NestedReferencesAreChecked) {
  folder_.write("inner.vrt", virtualRaster("/etc/passwd"));
  EXPECT_THAT(said(virtualRaster("inner.vrt"), true), HasSubstr("inner.vrt: names '/etc/passwd'"));
  folder_.write("inner.vrt",
                "<VRTDataset><VRTRasterBand subClass=\"VRTRawRasterBand\"><SourceFilename>"
                "/etc/passwd</SourceFilename></VRTRasterBand></VRTDataset>");
  EXPECT_THAT(said(virtualRaster("inner.vrt"), true), HasSubstr("inner.vrt: names '/etc/passwd'"));
  folder_.write("inner.vrt", virtualRaster("label"));
  EXPECT_THAT(said(virtualRaster("inner.vrt"), true), HasSubstr("names itself"));
  for (int level = 0; level < 9; ++level)
    folder_.write("v" + std::to_string(level), virtualRaster("v" + std::to_string(level + 1)));
  folder_.write("v9", "no raster");
  EXPECT_THAT(checked("v0", true), HasSubstr("more than eight"));
  EXPECT_EQ(checked("v2", true), "");
}

TEST_F(ReferencedFiles, SymbolicLinksOutOfTheFolderAreRejected) {
  write({.rows = kHill}, elsewhere_ / "secret.tif");
  fs::create_symlink(elsewhere_ / "secret.tif", folder_ / "a.tif");
  EXPECT_THAT(said(virtualRaster("a.tif"), true), HasSubstr("leads out of the folder"));
  EXPECT_THAT(said("<Product_Observational><file_name>a.tif</file_name></Product_Observational>"),
              HasSubstr("leads out of the folder"));
  EXPECT_THAT(said("PDS_VERSION_ID = PDS3\n^IMAGE = (\"A.TIF\", 3)\n"), HasSubstr("leads out of the folder"));
  // If the given file is a link, the folder of the target is also allowed.
  EXPECT_EQ(checked("a.tif"), "");
  write({.rows = kHill}, folder_ / "b.tif");
  fs::create_symlink("b.tif", folder_ / "c.tif");
  EXPECT_EQ(said(virtualRaster("c.tif"), true), "");
}

TEST_F(ReferencedFiles, SidecarFilesMustBeRegularFiles) {
  const std::string map = write({.rows = kHill}, folder_ / "map.tif");
  for (const char* name :
       {"map.tif.aux.xml", "map.tif.ovr", "map.tif.msk", "map.prj", "map.hdr", "map.TFW", "map_rpc.txt"}) {
    ASSERT_EQ(::mkfifo((folder_ / name).c_str(), 0600), 0);
    EXPECT_THAT(checked("map.tif"), HasSubstr("is a device, a FIFO")) << name;
    EXPECT_THAT(said(virtualRaster("map.tif"), true), HasSubstr("is a device, a FIFO")) << name;
    fs::remove(folder_ / name);
    fs::create_symlink("/etc/passwd", folder_ / name);
    EXPECT_THAT(checked("map.tif"), HasSubstr("leads out of the folder")) << name;
    fs::remove(folder_ / name);
  }
  folder_.write("map.tif.ovr", virtualRaster("/etc/passwd"));
  EXPECT_THAT(checked("map.tif"), HasSubstr("virtual raster"));
  EXPECT_THAT(checked("map.tif", true), HasSubstr("map.tif.ovr: names '/etc/passwd'"));
  fs::remove(folder_ / "map.tif.ovr");
  folder_.write("map.tif.aux.xml", "<PAMDataset><Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">" +
                                       (elsewhere_ / "secret.tif") + "</MDI></Metadata></PAMDataset>");
  EXPECT_THAT(checked("map.tif"), HasSubstr("no file of its own folder"));
  folder_.write("map.tif.aux.xml",
                "<PAMDataset><Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">"
                ":::BASE:::map.rrd</MDI></Metadata></PAMDataset>");
  EXPECT_EQ(checked("map.tif"), "");
}

}  // namespace referenced_files_test
}  // namespace talus::maps
