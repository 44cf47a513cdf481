#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

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

Format written(const std::string& driver, const std::string& name, GDALDataType type = GDT_Float32,
               const std::string& data = "") {
  return {driver,
          name,
          [=](const std::string& path) { write({.rows = heights(), .driver = driver, .type = type}, path); },
          data,
          {}};
}

std::vector<Format> formats() {
  std::vector<Format> all{written("GTiff", "a.tif"),         written("COG", "b.tif"),
                          written("ENVI", "c.img"),          written("PDS4", "d.xml", GDT_Float32, "d.img"),
                          written("ISIS3", "e.cub"),         written("AAIGrid", "f.asc"),
                          written("netCDF", "g.nc"),         written("JP2OpenJPEG", "h.jp2", GDT_Int16),
                          written("PNG", "i.png", GDT_Byte), written("JPEG", "j.jpg", GDT_Byte),
                          written("EHdr", "k.bil"),          written("GSAG", "l.grd"),
                          written("XYZ", "m.xyz"),           written("VICAR", "n.vic"),
                          written("PNM", "p.pgm", GDT_Byte)};
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

}  // namespace complete_file_test
}  // namespace talus::maps
