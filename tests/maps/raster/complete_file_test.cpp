#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <regex>
#include <set>

#include <talus/common/common.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>

#include "layer_fixture.hpp"
#include "raster_fixture.hpp"

namespace talus::maps {
namespace complete_file_test {

using testing::HasSubstr;

constexpr int kSide = 48;

// Integer heights from 100 to 200 m, which every format can store, each different from its neighbours.
std::vector<std::vector<double>> heights() {
  std::vector<std::vector<double>> rows;
  for (int row = 0; row < kSide; ++row) {
    rows.emplace_back();
    for (int column = 0; column < kSide; ++column)
      rows.back().push_back(150 + std::round(40 * std::sin(0.3 * column) + 9 * std::cos(0.7 * row)));
  }
  return rows;
}

std::string slurped(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void spill(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// A format: function that writes a file, and the file that contains the cells. Formats that GDAL cannot write
// are written as label and numbers.
struct Format {
  std::string driver, name;
  std::function<void(const std::string& path)> make;
  std::string data{};  // file with the cells if not `name`
  ReadOptions options{};
  float tolerance_m = 0.0F;
};

Format formatOf(const std::string& driver, const std::string& name, GDALDataType type = GDT_Float32,
                const std::string& data = "") {
  return {driver,
          name,
          [=](const std::string& path) { write({.rows = heights(), .driver = driver, .type = type}, path); },
          data,
          {}};
}

std::vector<Format> formats() {
  std::vector<Format> all{formatOf("GTiff", "a.tif"),         formatOf("COG", "b.tif"),
                          formatOf("ENVI", "c.img"),          formatOf("PDS4", "d.xml", GDT_Float32, "d.img"),
                          formatOf("ISIS3", "e.cub"),         formatOf("AAIGrid", "f.asc"),
                          formatOf("netCDF", "g.nc"),         formatOf("JP2OpenJPEG", "h.jp2", GDT_Int16),
                          formatOf("PNG", "i.png", GDT_Byte), formatOf("JPEG", "j.jpg", GDT_Byte),
                          formatOf("EHdr", "k.bil"),          formatOf("GSAG", "l.grd"),
                          formatOf("XYZ", "m.xyz"),           formatOf("VICAR", "n.vic"),
                          formatOf("PNM", "p.pgm", GDT_Byte)};
  for (Format& format : all) {
    format.options.ignore_crs = format.driver == "PNM";
    if (std::set<std::string>{"GSAG", "XYZ", "VICAR", "PNM"}.contains(format.driver))
      format.options.resolution_m = 10.0;
  }
  all.push_back(
      {"PDS",
       "o.img",
       [](const std::string& path) {
         std::string text =
             "PDS_VERSION_ID = PDS3\r\nRECORD_TYPE = FIXED_LENGTH\r\nRECORD_BYTES = 192\r\nFILE_RECORDS = "
             "52\r\n"
             "LABEL_RECORDS = 4\r\n^IMAGE = 5\r\nOBJECT = IMAGE\r\nLINES = 48\r\nLINE_SAMPLES = 48\r\n"
             "SAMPLE_TYPE = PC_REAL\r\nSAMPLE_BITS = 32\r\nEND_OBJECT = IMAGE\r\nEND\r\n";
         text.resize(768, ' ');
         for (const auto& row : heights())
           for (const double z : row) {
             const auto value = static_cast<float>(z);
             text.append(reinterpret_cast<const char*>(&value), sizeof value);
           }
         spill(path, text);
       },
       "",
       {.resolution_m = 10.0}});
  all.push_back({"SRTMHGT",
                 "N20E020.hgt",
                 [](const std::string& path) {
                   std::string bytes;
                   for (int k = 0; k < 1201 * 1201; ++k) {
                     const int z = 100 + k % 1201 / 2 + k / 1201 / 3;
                     bytes += {static_cast<char>(z >> 8), static_cast<char>(z & 255)};
                   }
                   spill(path, bytes);
                 },
                 "",
                 {.resolution_m = 90.0},
                 0.84F});  // degrees: resampled; a pixel away the heights differ by 0.5 m + 0.34 m at most
  return all;
}

// True if a damaged file is rejected, or has no height that differs from the undamaged file. The grid may be
// smaller by whole rows at one end. Beside unknown pixels a resampled height is interpolated from those that are
// left, within `tolerance_m`.
::testing::AssertionResult refusedOrUnknown(const std::string& path, const ReadOptions& options,
                                            const ElevationMap& whole, float tolerance_m) {
  ElevationMap map;
  const std::string line = refusal([&] { map = readElevation(path, options); });
  if (line.starts_with("another error")) return ::testing::AssertionFailure() << line;
  if (line != "accepted") return ::testing::AssertionSuccess() << "refused";
  const Grid &grid = map.grid(), &full = whole.grid();
  const int up =
      static_cast<int>(std::lround((grid.south_west.y_m - full.south_west.y_m) / full.resolution_m));
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const float z = map.elevation_m[{column, row}];
      if (std::isnan(z)) continue;
      if (row + up < 0 || row + up >= full.height ||
          std::abs(z - whole.elevation_m[{column, row + up}]) > tolerance_m)
        return ::testing::AssertionFailure() << z << " m in column " << column << ", row " << row;
    }
  return ::testing::AssertionSuccess() << "unknown";
}

// Property: a file of any format, cut at twenty places and before its last bytes, is rejected or has no data
// there.
TEST(CompleteFile, TruncatedFileOfAnyFormatIsRejectedOrNoData) {
  for (const Format& format : formats()) {
    const TemporaryFolder folder;
    const std::string path = folder / format.name, data = format.data.empty() ? path : folder / format.data;
    format.make(path);
    const ElevationMap whole = readElevation(path, format.options);
    const std::string bytes = slurped(data);
    ASSERT_GT(bytes.size(), 100U) << format.driver;
    std::vector<std::size_t> cuts{bytes.size() - 40, bytes.size() - 3};
    for (std::size_t k = 1; k <= 20; ++k) cuts.push_back(bytes.size() * k / 21);
    for (const std::size_t cut : cuts) {
      spill(data, bytes.substr(0, cut));
      EXPECT_TRUE(refusedOrUnknown(path, format.options, whole, format.tolerance_m))
          << format.driver << " cut to " << cut;
    }
  }
}

// Property: a raster of plain numbers with one byte more or fewer anywhere is rejected: all pixels behind it would
// be other numbers.
TEST(CompleteFile, InsertedOrRemovedByteIsRejected) {
  const std::set<std::string> plain{"ENVI",  "EHdr",    "PDS",    "PDS4", "ISIS3",
                                    "VICAR", "SRTMHGT", "netCDF", "GTiff"};
  for (const Format& format : formats()) {
    if (!plain.contains(format.driver)) continue;
    const TemporaryFolder folder;
    const std::string path = folder / format.name, data = format.data.empty() ? path : folder / format.data;
    format.make(path);
    const std::string bytes = slurped(data);
    // The size is the reason, not implausible numbers; GDAL knows SRTMHGT by its size alone.
    const char* reason = format.driver == "SRTMHGT" ? "GDAL opens no raster"
                         : format.driver == "GTiff" ? "blocks"
                                                    : " bytes";
    for (std::size_t k = 0; k < 16; ++k) {
      const std::size_t at = bytes.size() * (k / 2 + 9) / 17;  // in the second half: behind the label
      spill(data, bytes.substr(0, at) + (k % 2 == 0 ? "x" : "") + bytes.substr(at + k % 2));
      EXPECT_THAT(refusal([&] { readElevation(path, format.options); }), HasSubstr(reason)) << format.driver;
    }
  }
}

// A file system may store zeros of a complete GeoTIFF as holes; only its block offsets tell what is missing.
TEST(CompleteFile, HolesOfTheFileSystemAreNotMissingBlocks) {
  const TemporaryFolder folder;
  const std::string path = folder / "level.tif";
  write({.rows = std::vector<std::vector<double>>(256, std::vector<double>(256, 0.0))}, path);
  const std::string bytes = slurped(path);
  std::filesystem::remove(path);
  std::ofstream sparse(path, std::ios::binary);
  for (std::size_t at = 0; at < bytes.size(); at += 4096) {
    const std::string page = bytes.substr(at, 4096);
    if (page.find_first_not_of('\0') == page.npos) continue;
    sparse.seekp(static_cast<std::streamoff>(at));
    sparse << page;
  }
  sparse.close();
  std::filesystem::resize_file(path, bytes.size());
  EXPECT_EQ(validFraction(readElevation(path).elevation_m), 1.0);
}

// Property: one turned bit of the mask's header never makes all pixels valid.
TEST(CompleteFile, InternalMaskThatIsNotUsedIsRejected) {
  const TemporaryFolder folder;
  const std::string path = folder / "masked.tif";
  registerDrivers();
  CPLSetConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
  {
    const std::string plain = write({.rows = heights()}, folder / "plain.tif");
    const Dataset source = openRaster(plain);
    const Dataset file(
        driverNamed("GTiff").CreateCopy(path.c_str(), source.get(), FALSE, nullptr, nullptr, nullptr));
    ASSERT_EQ(file->CreateMaskBand(GMF_PER_DATASET), CE_None);
    std::vector<unsigned char> mask(kSide * kSide, 255);
    std::fill_n(mask.begin(), kSide * kSide / 4, static_cast<unsigned char>(0));
    ASSERT_EQ(file->GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, kSide, kSide, mask.data(),
                                                              kSide, kSide, GDT_Byte, 0, 0, nullptr),
              CE_None);
  }
  CPLSetConfigOption("GDAL_TIFF_INTERNAL_MASK", nullptr);
  const std::string bytes = slurped(path);
  ASSERT_EQ(validFraction(readElevation(path).elevation_m), 0.75);
  // The tag NewSubfileType (254, LONG, one value) of the mask has the value 4.
  const std::string tag("\xfe\0\x04\0\x01\0\0\0\x04\0\0\0", 12);
  const std::size_t at = bytes.find(tag);
  ASSERT_NE(at, bytes.npos);
  for (int bit = 0; bit < 8 * 12; ++bit) {
    std::string damaged = bytes;
    damaged[at + static_cast<std::size_t>(bit / 8)] ^= static_cast<char>(1 << (bit % 8));
    spill(path, damaged);
    double valid = 0.0;
    const std::string line = refusal([&] { valid = validFraction(readElevation(path).elevation_m); });
    EXPECT_TRUE(line != "accepted" || valid <= 0.75) << bit;
  }
}

// Property: files of every format that checks its blocks, and texts, with blocks overwritten by zeros, as after the loss
// of a sector or page, are rejected or have no data there.
TEST(CompleteFile, ZeroedBlocksOfCheckedFormatsAreRejectedOrNoData) {
  const std::set<std::string> checked{"COG", "PNG", "AAIGrid", "GSAG", "XYZ", "USGSDEM"};
  for (const Format& format : formats()) {
    if (!checked.contains(format.driver)) continue;
    const TemporaryFolder folder;
    const std::string path = folder / format.name, data = format.data.empty() ? path : folder / format.data;
    format.make(path);
    const ElevationMap whole = readElevation(path, format.options);
    const std::string bytes = slurped(data);
    const std::size_t step = bytes.size() > 1'000'000 ? 5 : 1;  // large files at fewer places
    for (const std::size_t block : {100U, 512U, 4096U})
      for (std::size_t k = 0; k < 20; k += step) {
        const std::size_t begin = bytes.size() * k / 20 / (block == 100 ? 4 : 512) * (block == 100 ? 4 : 512);
        std::string damaged = bytes;
        std::fill_n(damaged.begin() + static_cast<std::ptrdiff_t>(begin),
                    std::min(block, bytes.size() - begin), '\0');
        spill(data, damaged);
        EXPECT_TRUE(refusedOrUnknown(path, format.options, whole, format.tolerance_m))
            << format.driver << ", " << block << " bytes from " << begin << " of " << bytes.size();
      }
  }
}

// Property: each allowed driver is tested, except USGSDEM, which GDAL cannot write in a readable form and
// whose missing profiles are no data (usgsdemdataset.cpp).
TEST(CompleteFile, EveryAllowedFormatIsCovered) {
  std::set<std::string> cut{"USGSDEM"};
  for (const Format& format : formats()) cut.insert(format.driver);
  const std::vector<std::string> allowed = rasterFormats();
  EXPECT_EQ(cut, std::set<std::string>(allowed.begin(), allowed.end()));
}

// A GeoTIFF with unwritten blocks, as after its writer was killed.
void writeHalf(const std::string& path, std::optional<double> nodata, GDALDataType type = GDT_Float32) {
  registerDrivers();
  const char* const options[] = {"SPARSE_OK=TRUE", "TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16", nullptr};
  const std::unique_ptr<GDALDataset> file(
      driverNamed("GTiff").Create(path.c_str(), kSide, kSide, 1, type, const_cast<char**>(options)));
  std::array<double, 6> place{500000, 10, 0, 5000000, 0, -10};
  file->SetGeoTransform(place.data());
  OGRSpatialReference crs;
  crs.importFromEPSG(32610);
  file->SetSpatialRef(&crs);
  if (nodata) file->GetRasterBand(1)->SetNoDataValue(*nodata);
  std::vector<double> half(kSide * kSide / 3, 1.0);
  ASSERT_EQ(file->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, kSide, kSide / 3, half.data(), kSide, kSide / 3,
                                             GDT_Float64, 0, 0, nullptr),
            CE_None);
}

TEST(CompleteFile, UnwrittenBlocksAreRejectedOrNoData) {
  const TemporaryFolder folder;
  const std::string path = folder / "half.tif";
  writeHalf(path, std::nullopt);
  EXPECT_THAT(refusal([&] { readElevation(path); }), HasSubstr("is half written"));
  EXPECT_THAT(refusal([&] { readElevation(path, {.band = 1}); }), HasSubstr("is half written"));
  folder.write(
      "half.vrt",
      "<VRTDataset rasterXSize=\"48\" "
      "rasterYSize=\"48\"><GeoTransform>500000,10,0,5000000,0,-10</GeoTransform>"
      "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource><SourceFilename relativeToVRT=\"1\">"
      "half.tif</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>");
  EXPECT_THAT(refusal([&] { readElevation(folder / "half.vrt", {.resolution_m = 10.0, .allow_vrt = true}); }),
              HasSubstr("half.tif: is half written"));
  writeHalf(path, -9999.0);
  const ElevationMap map = readElevation(path);
  EXPECT_DOUBLE_EQ(validFraction(map.elevation_m), 1.0 / 3.0);
  const ElevationMap flat = readElevation(write({.rows = heights()}, folder / "whole.tif"));
  writeHalf(folder / "classes.tif", std::nullopt, GDT_Byte);
  EXPECT_THAT(refusal([&] { readRockAbundance({.path = folder / "classes.tif"}, flat); }),
              HasSubstr("is half written"));
}

TEST(CompleteFile, TextGridSmallerThanItsCellCountIsRejected) {
  const TemporaryFolder folder;
  EXPECT_THAT(
      refusal([&] {
        readElevation(
            folder.write("huge.asc", "ncols 20000\nnrows 20000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n"),
            {.resolution_m = 1.0});
      }),
      HasSubstr("is cut short: 63 of 800000000 bytes"));
}

// Property: an inserted or a lost value, and a header of other sizes, would move all values behind.
TEST(CompleteFile, TextGridOfAnotherNumberOfValuesIsRejected) {
  const TemporaryFolder folder;
  const auto line = [&](const std::string& size, const std::string& values) {
    return refusal([&] {
      readElevation(folder.write("g.asc", size + "xllcorner 0\nyllcorner 0\ncellsize 1\n" + values),
                    {.resolution_m = 1.0});
    });
  };
  EXPECT_EQ(line("ncols 3\nnrows 2\n", "1 2 3\n4 5 6\n"), "accepted");
  EXPECT_THAT(line("ncols 3\nnrows 2\n", "1 2 3\n3 4 5 6\n"),
              HasSubstr("holds 7 values, its header states 6"));
  EXPECT_THAT(line("ncols 3\nnrows 2\n", "1 2 3\n4 56\n"), HasSubstr("holds 5 values"));
  EXPECT_THAT(line("ncols 2\nnrows 2\n", "1 2 3\n4 5 6\n"), HasSubstr("holds 6 values"));
}

TEST(CompleteFile, PointFileTruncatedWithinANumberIsRejected) {
  const TemporaryFolder folder;
  std::string text;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      text += std::to_string(column) + " " + std::to_string(row) + " " + std::to_string(column + 0.25 * row) +
              "\n";
  const auto line = [&](const std::string& points) {
    return refusal([&] { readElevation(folder.write("p.xyz", points), {.resolution_m = 1.0}); });
  };
  EXPECT_EQ(line(text), "accepted");
  for (const std::size_t cut :
       {1U, 2U, 4U})  // the end of the line, too, because digits may be missing before
    EXPECT_THAT(line(text.substr(0, text.size() - cut)), HasSubstr("ends within a number"));
}

constexpr const char* kHeader =
    "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n";

std::vector<float> heights(const std::string& values) {
  const TemporaryFolder folder;
  const ElevationMap map =
      readElevation(folder.write("g.asc", kHeader + values), {.resolution_m = 1.0, .ignore_crs = true});
  return map.elevation_m.values();  // the southern row first
}

// Closed form: a grid of integers returns its values; words for "not a number" are no data.
TEST(TextGrid, NanInAWholeNumberGridIsNoData) {
  for (const char* word : {"nan", "NaN", "-nan", "-9999", "1.#QNAN", "-1.#IND"}) {
    const auto values = heights(std::string("1 ") + word + " 3\n4 5 6\n");
    ASSERT_EQ(values.size(), 6U);
    EXPECT_TRUE(std::isnan(values[4])) << word;
    EXPECT_EQ(values[0], 4.0F);
    EXPECT_EQ(values[3], 1.0F);
  }
  EXPECT_EQ(heights("1 2,5 +3\n4. .5 6e0\n"), (std::vector<float>{4.0F, 0.5F, 6.0F, 1.0F, 2.5F, 3.0F}));
}

TEST(TextGrid, InfiniteElevationsAreNoData) {
  for (const char* word : {"inf", "INF", "-inf", "infinity", "1.#INF", "1e999"}) {
    const auto values = heights(std::string("1 ") + word + " 3\n4 5 6\n");
    EXPECT_TRUE(std::isnan(values[4])) << word << ' ' << values[4];
  }
}

TEST(TextGrid, NonNumericFieldIsRejectedWithItsLine) {
  for (const char* word : {"abc", "NA", "x", "--", "0x7f", "12abc", "1,5,2", "1.5.2", "null", "+-3", "*"}) {
    const std::string text = std::string("1 2 3\n4 ") + word + " 6\n";
    EXPECT_THAT(refusal([&] { heights(text); }),
                HasSubstr("g.asc:8: '" + std::string(word) + "' is not a number"));
  }
  const TemporaryFolder folder;
  EXPECT_EQ(valuesOfGrid(folder.write("h.asc", "ncols 1\nnrows 1\nNODATA_value nan\n7")), 1U);
  EXPECT_THAT(refusal([&] { valuesOfGrid(folder.write("l.asc", "ncols 1\n" + std::string(9000, '1'))); }),
              HasSubstr("l.asc:2: '1111"));
}

TEST(TextGrid, ClassAndRockGridsAreValidatedEqually) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);  // four by three cells
  const std::string header = "ncols 4\nnrows 3\nxllcorner 500000\nyllcorner 4999970\ncellsize 10\n";
  const std::string words = folder.write("c.asc", header + "0 1 nan 1\n0 1 1 1\n0 0 0 0\n");
  EXPECT_EQ(drawing(readTerrainClasses({.path = words}, dem)), "01.1\n0111\n0000\n");
  const std::string junk = folder.write("j.asc", header + "0 1 road 1\n0 1 1 1\n0 0 0 0\n");
  EXPECT_THROW(readTerrainClasses({.path = junk}, dem), InputError);
  EXPECT_THROW(readRockAbundance({.path = junk}, dem), InputError);
}

// Property: what a label states and GDAL does not read, and statements that contradict each other, are refused.
TEST(CompleteFile, LabelThatGdalMisreadsIsRejected) {
  struct Edit {
    const char *driver, *from, *to, *reason;
  };
  for (const Edit& edit :
       std::initializer_list<Edit>{{"PDS", "END_OBJECT = IMAGE\r\n", "END_OBJECT = TABLE\r\n",
                                    "ends an object TABLE that does not begin"},
                                   {"PDS4", "Left to Right", "Right to Left", "states Right to Left"},
                                   {"EHdr", "XDIM", "XDUM", "states only a part of ULXMAP"},
                                   {"AAIGrid", "xllcorner", "xxlcorner", "states only a part of xllcorner"},
                                   {"XYZ", "150", "15\x80", "holds the byte 128 among its numbers"},
                                   {"netCDF", "", "@", "is cut short within its header"}}) {
    SCOPED_TRACE(edit.reason);
    const auto all = formats();
    const Format& format = *std::ranges::find(all, edit.driver, &Format::driver);
    const TemporaryFolder folder;
    const std::string path = folder / format.name;
    format.make(path);
    const std::string label = format.driver == "EHdr" ? folder / "k.hdr" : path;
    std::string bytes = slurped(label);
    const std::size_t at = format.driver == "netCDF" ? 12 : bytes.find(edit.from);  // number of dimensions
    ASSERT_NE(at, bytes.npos);
    bytes.replace(at, std::max<std::size_t>(std::string_view(edit.from).size(), 1), edit.to);
    spill(label, bytes);
    EXPECT_THAT(refusal([&] { readElevation(path, format.options); }), HasSubstr(edit.reason));
  }
  const TemporaryFolder folder;
  folder.write("p.hdr", "NROWS 5\nNCOLS 6\nNBITS 32\nPIXELTYPE FLOAT\nTOTALROWBYTES 32\n");
  EXPECT_THAT(refusal([&] { openRaster(folder.write("p.bil", std::string(160, '\0'))); }),
              HasSubstr("has lines of 32 bytes (TOTALROWBYTES), which GDAL reads"));
  folder.write("s.hdr", "NROWS 5\nNCOLS 6\nNBITS 8\nPIXELTYPE SIGNEDINT\n");
  EXPECT_THAT(refusal([&] { openRaster(folder.write("s.bil", std::string(30, '\1'))); }),
              HasSubstr("holds signed bytes"));
  const std::string moon =
      write({.rows = heights(), .driver = "ISIS3", .crs = "+proj=eqc +R=1737400"}, folder / "m.cub");
  std::string cube = slurped(moon);
  cube.replace(cube.find("PixelResolution      = "), 25, "PixelResolution      = 99");
  spill(moon, cube);
  EXPECT_THAT(refusal([&] { openRaster(moon); }),
              HasSubstr("size of pixels and pixels per degree that differ"));
}

// Property: a block that lies in the header of a GeoTIFF is refused, whether or not a value stands for no data.
TEST(CompleteFile, BlockInTheHeaderIsRejected) {
  const TemporaryFolder folder;
  const std::string cells(8 * 8 * 2, '\7');
  const auto u16 = [](std::uint32_t v) {
    return std::string{static_cast<char>(v), static_cast<char>(v >> 8U)};
  };
  const auto u32 = [&](std::uint32_t v) { return u16(v) + u16(v >> 16U); };
  const auto tiff = [&](std::uint32_t offset, bool declared) {
    std::string tags;
    const auto tag = [&](std::uint32_t number, std::uint32_t type, std::uint32_t value) {
      tags += u16(number) + u16(type) + u32(number == 42113 ? 4 : 1) + u32(value);
    };
    for (const std::uint32_t number : {256U, 257U}) tag(number, 3, 8);
    tag(258, 3, 16), tag(259, 3, 1), tag(262, 3, 1), tag(273, 4, offset), tag(277, 3, 1), tag(278, 3, 8);
    tag(279, 4, 128), tag(339, 3, 2);
    if (declared) tag(42113, 2, 0x0039392D);  // "-99"
    return folder.write(
        "t.tif", std::string("II*\0", 4) + u32(8 + 128) + cells + u16(declared ? 11 : 10) + tags + u32(0));
  };
  for (const bool declared : {false, true}) {
    EXPECT_EQ(refusal([&] { readElevation(tiff(8, declared), {.resolution_m = 1.0, .ignore_crs = true}); }),
              "accepted");
    for (const std::uint32_t offset : {0U, 4U})
      EXPECT_THAT(
          refusal([&] { readElevation(tiff(offset, declared), {.resolution_m = 1.0, .ignore_crs = true}); }),
          HasSubstr("blocks or tags that overlap"));
  }
}

// Damage by a grammar: every statement of a file and of those beside it is taken out, set to 0 or to another value, or has
// a bit turned or a byte inserted. Judged by the ground itself, which the reader does not know.

namespace fs = std::filesystem;

constexpr int kWidth = 24, kHeight = 18;
constexpr double kCell_m = 10.0, kWest_m = 500000.0, kNorth_m = 5000000.0;

// Height [m] at metres east of and south of the north-west corner; NaN in the void.
double heightAt(double east_m, double south_m) {
  const double column = east_m / kCell_m, row = south_m / kCell_m;
  if (column > 9 && column < 14 && row > 6 && row < 11) return std::nan("");
  return 1500.0 + 0.31 * east_m - 0.17 * south_m + 3.0 * std::sin(0.4 * column) * std::cos(0.3 * row);
}

// A way to write the ground.
struct Dialect {
  const char* ending;
  RasterFile file;
  double scale = 1.0, offset = 0.0;  // of the numbers
  double step_m = 0.01;              // of the stored heights
  const char* side = "";             // mask or auxiliary
};

std::vector<Dialect> dialects() {
  RasterFile plain{.type = GDT_Float32, .nodata = -9999.0};
  const auto as = [&](const char* driver) {
    RasterFile file = plain;
    file.driver = driver;
    return file;
  };
  const auto local = [&](const char* driver) {
    RasterFile file = as(driver);
    file.crs.clear();
    return file;
  };
  RasterFile scaled = plain, feet = plain, masked = plain, netcdf = as("netCDF"), undeclared = plain;
  scaled.type = GDT_Int16, scaled.nodata = -32768.0, scaled.scale = 0.01, scaled.offset = 1500.0;
  feet.unit = "ft";
  masked.nodata.reset();
  undeclared.nodata.reset();
  RasterFile kilometres = local("PDS3");
  kilometres.unit = "KILOMETER", kilometres.nodata = -32768.0;
  return {{"a.tif", plain},         {"b.tif", scaled, 0.01, 1500.0, 0.01},
          {"c.tif", feet, 0.3048},  {"d.tif", masked, 1.0, 0.0, 0.01, ".msk"},
          {"e.tif", undeclared},    {"f.img", as("ENVI")},
          {"g.bil", as("EHdr")},    {"h.asc", as("AAIGrid"), 1.0, 0.0, 0.1},
          {"i.xml", local("PDS4")}, {"j.cub", local("ISIS3")},
          {"k.nc", netcdf},         {"l.tif", plain, 1.0, 0.0, 0.01, ".aux.xml"},
          {"m.xyz", local("XYZ")},  {"n.lbl", kilometres, 1000.0},
          {"o.vic", local("VICAR")}};
}

// The bytes of a file of PDS3: its label and its numbers, in an equirectangular projection of the Moon where the file has a
// CRS, else without a place.
std::string pds3(const RasterFile& file) {
  const std::size_t width = file.rows.front().size(), height = file.rows.size(),
                    records = (1200 + 4 * width) / (4 * width);
  const auto line = [](const char* key, const std::string& value) {
    return std::string(key) + " = " + value + "\r\n";
  };
  const auto count = [](std::size_t n) { return std::to_string(n); };
  const auto& c = *file.transform;
  std::string text = line("PDS_VERSION_ID", "PDS3") + line("RECORD_TYPE", "FIXED_LENGTH") +
                     line("RECORD_BYTES", count(4 * width)) + line("FILE_RECORDS", count(records + height)) +
                     line("LABEL_RECORDS", count(records)) + line("^IMAGE", count(records + 1)) +
                     line("OBJECT", "IMAGE") + line("LINES", count(height)) +
                     line("LINE_SAMPLES", count(width)) + line("SAMPLE_TYPE", "PC_REAL") +
                     line("SAMPLE_BITS", "32") + line("UNIT", file.unit) +
                     line("MISSING_CONSTANT", "-32768.0") + line("END_OBJECT", "IMAGE");
  if (!file.crs.empty())
    text += line("OBJECT", "IMAGE_MAP_PROJECTION") + line("MAP_PROJECTION_TYPE", "\"EQUIRECTANGULAR\"") +
            line("A_AXIS_RADIUS", "1737.4 <KM>") + line("B_AXIS_RADIUS", "1737.4 <KM>") +
            line("C_AXIS_RADIUS", "1737.4 <KM>") + line("CENTER_LATITUDE", "0.0 <DEG>") +
            line("CENTER_LONGITUDE", "0.0 <DEG>") + line("TARGET_NAME", "MOON") +
            line("MAP_SCALE", std::to_string(c[1]) + " <METERS/PIXEL>") +
            line("MAP_RESOLUTION", std::to_string(1737400.0 * kDegree / c[1]) + " <PIXEL/DEG>") +
            line("SAMPLE_PROJECTION_OFFSET", std::to_string(-0.5 - c[0] / c[1])) +
            line("LINE_PROJECTION_OFFSET", std::to_string(-0.5 - c[3] / c[5])) +
            line("END_OBJECT", "IMAGE_MAP_PROJECTION");
  text += "END\r\n";
  text.resize(records * 4 * width, ' ');
  for (const auto& row : file.rows)
    for (const double each : row) {
      const auto value = static_cast<float>(each);
      text.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  return text;
}

// Writes the ground into an empty folder; returns the path of the file to read.
std::string written(const Dialect& dialect, const TemporaryFolder& folder) {
  RasterFile file = dialect.file;
  file.transform = std::array<double, 6>{kWest_m, kCell_m, 0, kNorth_m, 0, -kCell_m};
  std::vector<std::vector<double>> seen;
  for (int row = 0; row < kHeight; ++row) {
    file.rows.emplace_back();
    for (int column = 0; column < kWidth; ++column) {
      const double z = heightAt((column + 0.5) * kCell_m, (row + 0.5) * kCell_m);
      file.rows.back().push_back(std::isnan(z) ? file.nodata.value_or(-9999.0)
                                               : (z - dialect.offset) / dialect.scale);
    }
  }
  if (file.driver == "PDS3") return folder.write(dialect.ending, pds3(file));
  const std::string path = write(file, folder / dialect.ending);
  if (dialect.side == std::string(".aux.xml"))
    folder.write("l.tif.aux.xml",
                 "<PAMDataset>\n  <PAMRasterBand band=\"1\">\n    <NoDataValue>-9999</NoDataValue>\n"
                 "    <UnitType>m</UnitType>\n  </PAMRasterBand>\n</PAMDataset>\n");
  if (dialect.side == std::string(".msk")) {
    const GDALDatasetUniquePtr raster(GDALDataset::Open(path.c_str(), GDAL_OF_UPDATE));
    EXPECT_EQ(raster->CreateMaskBand(GMF_PER_DATASET), CE_None);
    for (int row = 0; row < kHeight; ++row)
      for (int column = 0; column < kWidth; ++column) {
        unsigned char known = std::isnan(heightAt((column + 0.5) * kCell_m, (row + 0.5) * kCell_m)) ? 0 : 255;
        EXPECT_EQ(raster->GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, column, row, 1, 1, &known, 1, 1,
                                                                    GDT_Byte, 0, 0, nullptr),
                  CE_None);
      }
  }
  return path;
}

ReadOptions optionsOf(const Dialect& dialect) {
  ReadOptions options{.keep_holes = true};
  if (dialect.file.crs.empty()) options.resolution_m = kCell_m;
  return options;
}

// A statement of a file, and the bytes of its value.
struct Statement {
  std::string name;
  std::size_t begin, end, value, value_end;
  bool tag = false;
};

std::uint32_t word(const std::string& bytes, std::size_t at, std::size_t count = 4) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count && at + i < bytes.size(); ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return value;
}

// Tags of a TIFF; lines "key = value" or elements of XML of a text; else the words at the beginning.
std::vector<Statement> statementsOf(const std::string& bytes) {
  std::vector<Statement> found;
  if (bytes.starts_with(std::string("II*\0", 4))) {
    constexpr std::size_t kSizes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8};
    for (std::size_t at = word(bytes, 4); at != 0 && at + 2 < bytes.size();) {
      const std::size_t count = word(bytes, at, 2);
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t entry = at + 2 + 12 * i;
        const std::size_t size = kSizes[word(bytes, entry + 2, 2) % 13] * word(bytes, entry + 4);
        const std::size_t value = size > 4 ? word(bytes, entry + 8) : entry + 8;
        found.push_back({std::to_string(word(bytes, entry, 2)), entry, entry + 12, value,
                         std::min(bytes.size(), value + std::max<std::size_t>(size, 1)), true});
      }
      at = word(bytes, at + 2 + 12 * count);
    }
    return found;
  }
  const bool text = std::ranges::all_of(
      bytes.substr(0, 64), [](unsigned char c) { return c >= 0x20 ? c < 0x7F : std::isspace(c) != 0; });
  if (!text && !bytes.starts_with("CDF")) return found;
  static const std::regex kText(
      R"(([A-Za-z^_][\w:^ ]*?(?= *=)|[A-Za-z^_][\w:^]*)( *= *| +|[^<>]*>)([ -;=?-~]+)(\r?\n|</))");
  const std::string head = bytes.substr(0, 4000);
  for (std::sregex_iterator at(head.begin(), head.end(), kText), end; at != end; ++at) {
    const auto begin = static_cast<std::size_t>(at->position(0)),
               value = static_cast<std::size_t>(at->position(3));
    found.push_back({at->str(1), begin, begin + at->str(0).size(), value, value + at->str(3).size()});
  }
  for (std::size_t at = 0; bytes.starts_with("CDF") && at + 4 <= head.size() && at < 400; at += 4)
    found.push_back({"word", at, at + 4, at, at + 4});
  return found;
}

constexpr const char* kWays[] = {"absent", "0", "other", "bit", "byte"};

std::string damaged(std::string bytes, const Statement& s, std::size_t way, std::mt19937& random) {
  const auto any = [&](std::size_t below) { return random() % std::max<std::size_t>(below, 1); };
  const std::size_t size = s.value_end - s.value, at = s.value + any(size);
  if (way == 0 && s.tag) {
    // The entries behind it and the offset of the next image move up.
    const std::size_t first = s.begin - s.begin % 2;
    std::size_t directory = word(bytes, 4);
    while (directory != 0 && first >= directory + 2 + 12 * word(bytes, directory, 2))
      directory = word(bytes, directory + 2 + 12 * word(bytes, directory, 2));
    const std::size_t count = word(bytes, directory, 2), end = directory + 6 + 12 * count;
    bytes.replace(first, end - first, bytes.substr(first + 12, end - first - 12) + std::string(12, '\0'));
    bytes[directory] = static_cast<char>(count - 1);
  } else if (way == 0) {
    bytes.erase(s.begin, s.end - s.begin);
  } else if (way == 1) {
    bytes.replace(s.value, size, s.tag ? std::string(size, '\0') : "0");
  } else if (way == 2) {
    char* end = nullptr;
    const std::string text = bytes.substr(s.value, size);
    const double number = std::strtod(text.c_str(), &end);
    if (s.tag || s.name == "word")
      bytes[at] = static_cast<char>(random());
    else
      bytes.replace(s.value, size, end == text.c_str() ? "other" : std::to_string(2.0 * number + 1.0));
  } else if (way == 3) {
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << any(8)));
  } else {
    bytes.insert(at, 1, static_cast<char>(random()));
  }
  return bytes;
}

// The worst fault of a map: unknown ground is safe, another height is not. Empty if there is none.
std::string faultOf(const ElevationMap& map, double step_m) {
  Grid grid = map.grid();
  if (!map.georeference) grid.south_west = {kWest_m, kNorth_m - kHeight * kCell_m};
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const auto z = static_cast<double>(map.elevation_m[{column, row}]);
      if (std::isnan(z)) continue;
      const double east_m = grid.south_west.x_m + (column + 0.5) * grid.resolution_m - kWest_m,
                   south_m = kNorth_m - grid.south_west.y_m - (row + 0.5) * grid.resolution_m;
      const double truth_m = heightAt(east_m, south_m);
      if (std::isnan(truth_m)) return "ground in the void";
      if (std::abs(z - truth_m) > step_m + 1e-3)
        return std::to_string(z) + " m instead of " + std::to_string(truth_m) + " m";
    }
  return "";
}

TEST(Damage, WholeFilesAreReadAsTheGround) {
  for (const Dialect& dialect : dialects()) {
    const TemporaryFolder folder;
    const ElevationMap map = readElevation(written(dialect, folder), optionsOf(dialect));
    EXPECT_EQ(faultOf(map, dialect.step_m), "") << dialect.ending;
    EXPECT_NEAR(validFraction(map.elevation_m), 1.0 - 25.0 / (kWidth * kHeight), 1e-9) << dialect.ending;
  }
}

OGRSpatialReference crsOf(const std::string& text) {
  OGRSpatialReference crs;
  crs.SetFromUserInput(text.c_str());
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

// Property: one ground is the same map in every format, frame, unit and offset, within the error of cubic interpolation,
// and its void (declared or not) is ground in none.
TEST(Damage, GroundIsTheSameInEveryFrame) {
  struct Frame {
    std::string crs;
    std::array<double, 6> transform;
    std::string unit = "";
    double size_m = 1.0, raised_m = 0.0;
    std::string ending = "tif", driver = "GTiff";
    std::optional<double> nodata = std::nullopt;
    double step = 0.0;  // of the numbers, which are then of 16 bits
  };
  const std::string utm_name = "EPSG:32610", moon = "+proj=eqc +R=1737400", degrees = "EPSG:4326";
  constexpr double kTurn = 0.3;
  const std::array<double, 6> own{kWest_m, kCell_m, 0, kNorth_m, 0, -kCell_m},
      on_moon{1000, kCell_m, 0, 20000, 0, -kCell_m}, in_degrees{-123.0, 1.2e-4, 0, 45.1535, 0, -0.9e-4};
  const Frame frames[] = {
      {degrees, in_degrees},
      {"EPSG:3857", {-13692297.0, 14.0, 0, 5645700.0, 0, -14.0}},
      {utm_name, {kWest_m, kCell_m, 0, kNorth_m, 0, -0.6 * kCell_m}},
      {utm_name,
       {kWest_m + 40, 8 * std::cos(kTurn), 8 * std::sin(kTurn), kNorth_m - 50, 8 * std::sin(kTurn),
        -8 * std::cos(kTurn)}},
      {utm_name, {kWest_m, kCell_m, 0, kNorth_m - 2 * kHeight * kCell_m, 0, kCell_m}},  // rows run north
      {utm_name, own, "km", 1000.0},
      {utm_name, own, "US survey foot", 1200.0 / 3937.0},
      {utm_name, own, "", 1.0, -5000.0, "tif", "GTiff", -32768.0},
      {utm_name, own, "", 1.0, 0.0, "tif", "GTiff", -32768.0, 0.05},
      {utm_name, own, "m", 1.0, 0.0, "bil", "EHdr"},
      {utm_name, own, "", 1.0, 0.0, "img", "ENVI"},
      {utm_name, own, "", 1.0, 0.0, "asc", "AAIGrid", -32768.0},
      {utm_name, own, "", 1.0, -1500.0, "nc", "netCDF"},
      {degrees, in_degrees, "", 1.0, 0.0, "nc", "netCDF"},
      {moon, on_moon, "", 1.0, 0.0, "xml", "PDS4", -32768.0},
      {moon, on_moon, "", 1.0, 0.0, "cub", "ISIS3"},
      {moon, on_moon, "KILOMETER", 1000.0, 0.0, "lbl", "PDS3"}};
  for (const Frame& frame : frames) {
    SCOPED_TRACE(frame.crs + " " + frame.driver + " " + frame.unit);
    const bool earth = frame.crs != moon;
    const OGRSpatialReference crs = crsOf(frame.crs), ground = crsOf(earth ? utm_name : moon);
    const std::unique_ptr<OGRSpatialReference> places(ground.CloneGeogCS());
    places->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const std::unique_ptr<OGRCoordinateTransformation> from_file(
        OGRCreateCoordinateTransformation(&crs, &ground)),
        from_place(OGRCreateCoordinateTransformation(places.get(), &ground));
    const auto truthAt = [&](OGRCoordinateTransformation& to_ground, double x, double y) {
      to_ground.Transform(1, &x, &y);
      const double east_m = x - (earth ? own : on_moon)[0], south_m = (earth ? own : on_moon)[3] - y;
      const bool inside = east_m > -50 && south_m > -50 && east_m < 300 && south_m < 250;
      return inside ? heightAt(east_m, south_m) + frame.raised_m : std::nan("");
    };
    RasterFile file{.driver = frame.driver,
                    .crs = frame.crs,
                    .transform = frame.transform,
                    .nodata = frame.nodata,
                    .unit = frame.unit};
    if (frame.step > 0.0) file.type = GDT_Int16, file.scale = frame.step, file.offset = 1500.0;
    const auto& c = frame.transform;
    for (int row = 0; row < 2 * kHeight; ++row) {
      file.rows.emplace_back();
      for (int column = 0; column < kWidth; ++column) {
        const double u = column + 0.5, v = row + 0.5;
        const double z = truthAt(*from_file, c[0] + u * c[1] + v * c[2], c[3] + u * c[4] + v * c[5]);
        file.rows.back().push_back(std::isnan(z) ? -32768.0 : (z / frame.size_m - file.offset) / file.scale);
      }
    }
    const TemporaryFolder folder;
    const std::string path = folder / ("ground." + frame.ending);
    const ElevationMap map =
        readElevation(frame.driver == "PDS3" ? folder.write("ground.lbl", pds3(file)) : write(file, path),
                      {.keep_holes = true});
    const Grid& grid = map.grid();
    double worst_m = 0.0, known = 0.0;
    for (Cell cell{}; cell.row < grid.height; ++cell.row)
      for (cell.column = 0; cell.column < grid.width; ++cell.column) {
        const auto z = static_cast<double>(map.elevation_m[cell]);
        if (std::isnan(z)) continue;
        bool rim = false;  // where cubic interpolation lacks a side
        for (int k = 0; k < 25; ++k) {
          const Cell near{cell.column + k % 5 - 2, cell.row + k / 5 - 2};
          rim = rim || !grid.contains(near) || std::isnan(map.elevation_m[near]);
        }
        const GeoPoint place = map.georeference->reverse(grid.centre(cell));
        const double truth =
            truthAt(*from_place, place.longitude_rad / kDegree, place.latitude_rad / kDegree);
        if (!rim) worst_m = std::max(worst_m, std::isnan(truth) ? 1e9 : std::abs(z - truth));
        // The height of one cell's slope.
        EXPECT_TRUE(!rim || std::isnan(truth) || std::abs(z - truth) < 3.5);
        known += 1.0;
      }
    EXPECT_LT(worst_m, 0.25);
    EXPECT_GT(known, 250.0);
  }
}

// Places, sizes of pixels, scales, offsets and units, to which a file holds no second statement: docs/limits.md.
bool isStatedLimit(const std::string& name) {
  static const std::regex kAlone(
      "42112|33550|33922|[xy]llcorner|cellsize|U[LR][XY]MAP|[XY]DIM|map info|Multiplier|Base|UNIT");
  return std::regex_match(name, kAlone);
}

// Property: a damaged file is refused, or what is read of it is the ground. The number of files is
// TALUS_DAMAGED_FILES, 300 if not set.
TEST(Damage, DamagedStatementIsRefusedOrHarmless) {
  const char* more = std::getenv("TALUS_DAMAGED_FILES");
  const int count = more ? std::atoi(more) : 300;
  std::mt19937 random(11);
  std::map<std::string, int> sums;
  const std::vector<Dialect> all = dialects();
  std::vector<std::map<std::string, std::string>> whole;  // files of each dialect
  for (const Dialect& dialect : all) {
    const TemporaryFolder folder;
    whole.emplace_back();
    for (const auto& entry : fs::directory_iterator(fs::path(written(dialect, folder)).parent_path())) {
      std::ifstream stream(entry.path(), std::ios::binary);
      whole.back()[entry.path().filename()] = {std::istreambuf_iterator<char>(stream), {}};
    }
  }
  for (int k = 0; k < count; ++k) {
    const std::size_t of = static_cast<std::size_t>(k) % all.size();
    const Dialect& dialect = all[of];
    const TemporaryFolder folder;
    for (const auto& [each, content] : whole[of]) folder.write(each, content);
    const std::string path = folder / dialect.ending;
    const auto chosen =
        std::next(whole[of].begin(), static_cast<std::ptrdiff_t>(random() % whole[of].size()));
    const fs::path file = folder / chosen->first;
    const std::string& bytes = chosen->second;
    const auto statements = statementsOf(bytes);
    const std::size_t way = random() % std::size(kWays);
    std::string name = "file";
    if (statements.empty() || (file != path && random() % 8 == 0)) {
      if (way == 0)
        fs::remove(file);
      else
        folder.write(chosen->first, bytes.substr(0, bytes.size() / 2));
    } else {
      const Statement& statement = statements[random() % statements.size()];
      name = statement.name;
      folder.write(chosen->first, damaged(bytes, statement, way, random));
    }
    testing::internal::CaptureStderr();
    std::string fault,
        outcome = refusal([&] { fault = faultOf(readElevation(path, optionsOf(dialect)), dialect.step_m); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(outcome.find('\n'), outcome.npos);
    const bool refused = outcome != "accepted";
    ++sums[refused               ? "refused"
           : fault.empty()       ? "right"
           : isStatedLimit(name) ? "stated limit"
                                 : "less safe"];
    if (more && !refused && !fault.empty())
      std::printf("%s %s: %s, %s\n", file.filename().c_str(), name.c_str(), kWays[way], fault.c_str());
    EXPECT_FALSE(outcome.starts_with("another error")) << outcome;
    EXPECT_TRUE(refused || fault.empty() || isStatedLimit(name))
        << "file " << k << ": " << file.filename() << ", " << name << " " << kWays[way] << ": " << fault;
  }
  for (const auto& [name, sum] : sums) RecordProperty(name, sum);
  if (more)
    for (const auto& [name, sum] : sums) std::printf("%s: %d of %d\n", name.c_str(), sum, count);
}

}  // namespace complete_file_test
}  // namespace talus::maps
