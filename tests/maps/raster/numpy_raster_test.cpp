#include <fstream>
#include <utility>

#include <refused.hpp>

#include <talus/common/common.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/maps/raster/intake.hpp>
#include <talus/maps/raster/numpy_raster.hpp>

#include "raster_fixture.hpp"
#include "requirement.hpp"

namespace talus::maps {
namespace numpy_raster_test {

using testing::Contains;
using testing::HasSubstr;

TEST(NumpyRaster, ReadsTheJacksboroElevationMap) {
  const std::string path = "/usr/share/matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz";
  TALUS_REQUIRE(std::filesystem::exists(path), "python-matplotlib-data is not installed");
  const ElevationMap map = readElevation(path);
  EXPECT_THAT(map.notes, Contains(HasSubstr("ymin and ymax are in the wrong order")));
  // Printed in: the file. 403 x 344 cells of 3 arc seconds about 36.59 N, 84.25 W, heights 238 to 1076 m.
  const Point middle = map.georeference->forward({36.5895833 * kDegree, -84.2458333 * kDegree});
  EXPECT_NEAR(middle.x_m, 0, 1);
  EXPECT_NEAR(middle.y_m, 0, 1);
  EXPECT_NEAR(map.grid().width * map.grid().resolution_m, 30100, 150);
  EXPECT_NEAR(map.grid().height * map.grid().resolution_m, 31850, 150);
  // Row 20 of column 30 has 507 m; it is in the north only if the swapped limits are corrected.
  const Point inside = map.georeference->forward({36.7158333 * kDegree, -84.3883333 * kDegree});
  EXPECT_NEAR(elevationAt(map.elevation_m, inside).value(), 507,
              8);  // difference of neighbouring cells
}

// A .npy file of 64-bit floats.
std::string npy(const std::string& shape, const std::vector<double>& values) {
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + shape + "), }\n";
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(header.size());
  out += '\0';
  out += header;
  return out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
}

// GDAL writes archives only with the ending .zip.
std::string npz(const std::string& path, const std::vector<std::pair<std::string, std::string>>& files) {
  const std::string archive = "/vsizip/" + path + ".zip";
  VSILFILE* zip = VSIFOpenL(archive.c_str(), "wb");
  for (const auto& [name, bytes] : files) {
    VSILFILE* file = VSIFOpenL((archive + "/" + name + ".npy").c_str(), "wb");
    EXPECT_EQ(VSIFWriteL(bytes.data(), 1, bytes.size(), file), bytes.size());
    VSIFCloseL(file);
  }
  VSIFCloseL(zip);
  std::filesystem::rename(path + ".zip", path);
  return path;
}

TEST(NumpyRaster, ArrayRowsAreRasterRows) {
  const TemporaryFolder folder;
  std::vector<std::string> notes;
  const Dataset raster = openNumpyRaster(folder.write("z.npy", npy("2, 3", {1, 2, 3, 4, 5, 6})), notes);
  ASSERT_EQ(raster->GetRasterXSize(), 3);
  ASSERT_EQ(raster->GetRasterYSize(), 2);
  EXPECT_THAT(Quantity().of({*raster, 1, {.width = 3, .height = 2}, "z"}),
              testing::ElementsAre(1, 2, 3, 4, 5, 6));
  std::array<double, 6> transform{};
  EXPECT_NE(raster->GetGeoTransform(transform.data()), CE_None);
}

TEST(NumpyRaster, LimitsAreOuterEdges) {
  const TemporaryFolder folder;
  const std::string path = npz(folder / "z.npz", {{"elevation", npy("2, 4", std::vector<double>(8, 5.0))},
                                                  {"xmin", npy("", {1000})},
                                                  {"xmax", npy("", {1400})},
                                                  {"ymin", npy("", {-200})},
                                                  {"ymax", npy("", {0})}});
  std::vector<std::string> notes;
  const Dataset raster = openNumpyRaster(path, notes);
  std::array<double, 6> transform{};
  ASSERT_EQ(raster->GetGeoTransform(transform.data()), CE_None);
  // Closed form: 400 m over four columns, 200 m over two rows, from the north-west corner.
  EXPECT_THAT(transform, testing::ElementsAre(1000, 100, 0, 0, 0, -100));
  EXPECT_EQ(raster->GetSpatialRef(), nullptr);  // values of 1000 and more are not degrees
  EXPECT_TRUE(notes.empty());
}

TEST(NumpyRaster, ArraysThatAreNoElevationGridAreRejected) {
  const TemporaryFolder folder;
  std::vector<std::string> notes;
  const auto line = [&](const std::string& path) { return refusal([&] { openNumpyRaster(path, notes); }); };
  EXPECT_THAT(line(folder.write("row.npy", npy("3,", {1, 2, 3}))), HasSubstr("has not two axes"));
  EXPECT_THAT(line(folder.write("none.npy", npy("0, 3", {}))), HasSubstr("has not two axes"));
  const std::string grid = npy("1, 2", {1, 2});
  EXPECT_THAT(line(npz(folder / "two.npz", {{"a", grid}, {"b", grid}})),
              HasSubstr("several arrays of two axes ('a', 'b')"));
  EXPECT_EQ(line(npz(folder / "named.npz", {{"a", grid}, {"elevation", grid}})), "accepted");
  EXPECT_THAT(line(npz(folder / "flat.npz", {{"a", npy("2,", {1, 2})}})), HasSubstr("no array of two axes"));
}

std::string number(std::size_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i));
  return out;
}

// An uncompressed zip archive of one file, as written by numpy.savez.
std::string stored(const std::string& name, const std::string& content) {
  const std::string sizes = number(crc32(content), 4) + number(content.size(), 4) +
                            number(content.size(), 4) + number(name.size(), 2) + number(0, 2);
  const std::string start = number(20, 2) + std::string(8, '\0');  // version, flags, method, time, date
  const std::string file = "PK\3\4" + start + sizes + name + content;
  const std::string directory = "PK\1\2" + number(20, 2) + start + sizes + std::string(14, '\0') + name;
  return file + directory + "PK\5\6" + number(0, 4) + number(1, 2) + number(1, 2) +
         number(directory.size(), 4) + number(file.size(), 4) + number(0, 2);
}

TEST(NumpyRaster, ModifiedArchiveIsRejected) {
  const TemporaryFolder folder;
  std::vector<std::string> notes;
  const std::string whole = stored("elevation.npy", npy("2, 3", {1, 2, 3, 4, 5, 6}));
  const std::size_t directory = whole.rfind("PK\1\2");
  const auto changed = [&](std::size_t at, int with) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ with);
    const std::string path = folder.write("z.npz", bytes);
    return refusal([&] { openNumpyRaster(path, notes); });
  };
  EXPECT_EQ(changed(0, 0), "accepted");
  EXPECT_NE(changed(directory - 3, 1), "accepted");
  EXPECT_NE(changed(directory + 16, 1), "accepted");
  EXPECT_THAT(changed(directory + 8, 1), HasSubstr("is encrypted"));
  EXPECT_THAT(changed(directory, 1), HasSubstr("directory of files is damaged"));
}

}  // namespace numpy_raster_test

namespace numpy_array_test {

using testing::ElementsAre;
using testing::HasSubstr;

std::string file(const std::string& header, const std::string& data) {
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(header.size());
  out += '\0';
  return out + header + data;
}

TEST(NumpyArray, ReadsIntegersOfEitherByteOrder) {
  const std::string little = file("{'descr': '<i2', 'fortran_order': False, 'shape': (2, 2), }\n",
                                  std::string("\1\0\2\0\xff\xff\0\1", 8));
  EXPECT_THAT(parseNumpy(little, "a").values, ElementsAre(1, 2, -1, 256));
  EXPECT_THAT(parseNumpy(little, "a").shape, ElementsAre(2U, 2U));
  const std::string big =
      file("{'descr': '>i2', 'fortran_order': False, 'shape': (2,), }\n", std::string("\0\1\1\0", 4));
  EXPECT_THAT(parseNumpy(big, "a").values, ElementsAre(1, 256));
}

TEST(NumpyArray, ReadsFortranOrderAndScalars) {
  const std::string fortran =
      file("{'descr': '|u1', 'fortran_order': True, 'shape': (2, 3), }\n", "\1\2\3\4\5\6");
  EXPECT_THAT(parseNumpy(fortran, "a").values, ElementsAre(1, 3, 5, 2, 4, 6));
  const std::string one = file("{'descr': '<f8', 'fortran_order': False, 'shape': (), }\n",
                               std::string("\0\0\0\0\0\0\xf0\x3f", 8));
  EXPECT_THAT(parseNumpy(one, "a").values, ElementsAre(1.0));
  EXPECT_TRUE(parseNumpy(one, "a").shape.empty());
}

TEST(NumpyArray, TruncatedDataIsRejected) {
  EXPECT_REFUSED(parseNumpy(file("{'descr': '<f8', 'fortran_order': False, 'shape': (), }\n", ""), "a"),
                 InputError, "the file is cut short");
  EXPECT_REFUSED(
      parseNumpy(file("{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }\n", "1234567"), "a"),
      InputError, "the file is cut short");
}

TEST(NumpyArray, ExtentsMustBeDecimalIntegers) {
  for (const auto& [shape, text] : {std::pair{"(-1, 3)", "has the extent '-1'"},
                                    {"(1.5, 2)", "has the extent '1.5'"},
                                    {"(3e0,)", "has the extent '3e0'"},
                                    {"(0x3,)", "has the extent '0x3'"},
                                    {"(two,)", "has the extent 'two'"},
                                    {"(4294967296,)", "array is too large"}})
    EXPECT_REFUSED(
        parseNumpy(file("{'descr': '<f8', 'fortran_order': False, 'shape': " + std::string(shape) + ", }\n",
                        std::string(24, '\0')),
                   "a"),
        InputError, text);
}

// Property: long headers are rejected, because the regular expression uses stack memory for each character,
// and a header of version 2 may have 4 GB.
TEST(NumpyArray, HeaderAboveItsLimitIsRejected) {
  for (const char* filling : {"1,", " "}) {
    std::string shape;
    while (shape.size() < 1'000'000) shape += filling;
    const std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + shape + "), }\n";
    std::string bytes("\x93NUMPY\x02\x00", 8);
    for (std::size_t k = 0; k < 4; ++k) bytes += static_cast<char>(header.size() >> (8 * k) & 0xFFU);
    EXPECT_REFUSED(parseNumpy(bytes + header + std::string(8, '\0'), "a"), InputError,
                   "the NumPy header is longer than 10000 characters")
        << filling;
  }
}

TEST(NumpyArray, MalformedArraysAreRejected) {
  const auto line = [](const std::string& bytes) {
    try {
      parseNumpy(bytes, "x.npy");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(line(""), HasSubstr("x.npy: not a NumPy array"));
  EXPECT_THAT(line(std::string("\x93NUMPY\x01\x00\xff\xff{}", 12)), HasSubstr("header is cut short"));
  EXPECT_THAT(line(file("{'descr': '|O', 'fortran_order': False, 'shape': (2,), }", "")),
              HasSubstr("plain numbers"));
  EXPECT_THAT(line(file("{'descr': '<f2', 'fortran_order': False, 'shape': (2,), }", "1234")),
              HasSubstr("f2 are not supported"));
  EXPECT_THAT(line(file("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 9), }", "1234")),
              HasSubstr("cut short"));
  EXPECT_THAT(line(file("{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999,), }", "1")),
              HasSubstr("too large"));
  EXPECT_THAT(
      line(file("{'descr': '<f8', 'fortran_order': False, 'shape': (999999999,999999999,999999999), }", "1")),
      HasSubstr("cut short"));
}

TEST(NumpyArray, VersionOrderAndLengthFollowTheFormat) {
  const std::string good = file("{'descr': '|u1', 'fortran_order': False, 'shape': (3,), }\n", "abc");
  EXPECT_NO_THROW(parseNumpy(good, "a"));
  for (const char version : {'\0', '\4', '\xff'}) {
    std::string bytes = good;
    bytes[6] = version;
    EXPECT_THROW(parseNumpy(bytes, "a"), InputError);
  }
  EXPECT_THROW(parseNumpy(good + "d", "a"), InputError);
  for (const char* order : {"", "'fortran_order': 1, ", "'fortran_order': true, "})
    EXPECT_THROW(
        parseNumpy(file("{'descr': '|u1', " + std::string(order) + "'shape': (3,), }\n", "abc"), "a"),
        InputError);
}

}  // namespace numpy_array_test

namespace zip_directory_test {

// Printed in: catalogues of CRCs, the check value of CRC-32/ISO-HDLC.
TEST(ZipDirectory, ChecksumMatchesCrc32) {
  EXPECT_EQ(crc32("123456789"), 0xCBF43926U);
  EXPECT_EQ(crc32(""), 0U);
}

TEST(ZipDirectory, FileWithoutDirectoryIsRejected) {
  const TemporaryFolder folder;
  for (const std::string& bytes :
       {std::string("x"), std::string(100, 'x'), "PK\5\6" + std::string(18, '\xff')})
    EXPECT_REFUSED(zipDirectory(folder.write("a.npz", bytes)), InputError,
                   "its directory of files is damaged or missing");
}

}  // namespace zip_directory_test

}  // namespace talus::maps
