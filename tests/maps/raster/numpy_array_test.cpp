#include <utility>

#include <refused.hpp>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/numpy_raster.hpp>

namespace talus::maps {
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
}  // namespace talus::maps
