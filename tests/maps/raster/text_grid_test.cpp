#include <cmath>

#include <talus/common/input_error.hpp>
#include <talus/maps/raster/text_grid.hpp>

#include "layer_fixture.hpp"

namespace talus::maps {
namespace text_grid_test {

using testing::HasSubstr;

constexpr const char* kHeader =
    "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n";

std::vector<float> heights(const std::string& values) {
  const TemporaryFolder folder;
  const ElevationMap map =
      readElevation(folder.write("g.asc", kHeader + values), {.resolution_m = 1.0, .ignore_crs = true});
  return map.elevation_m.values();  // the southern row first
}

// Closed form: a grid of whole numbers holds what it says, words for "not a number" included.
TEST(TextGrid, NanAmongWholeNumbersIsNoData) {
  for (const char* word : {"nan", "NaN", "-nan", "-9999", "1.#QNAN", "-1.#IND"}) {
    const auto values = heights(std::string("1 ") + word + " 3\n4 5 6\n");
    ASSERT_EQ(values.size(), 6U);
    EXPECT_TRUE(std::isnan(values[4])) << word;
    EXPECT_EQ(values[0], 4.0F);
    EXPECT_EQ(values[3], 1.0F);
  }
  EXPECT_EQ(heights("1 2,5 +3\n4. .5 6e0\n"), (std::vector<float>{4.0F, 0.5F, 6.0F, 1.0F, 2.5F, 3.0F}));
}

TEST(TextGrid, InfiniteHeightsAreNoGround) {
  for (const char* word : {"inf", "INF", "-inf", "infinity", "1.#INF", "1e999"}) {
    const auto values = heights(std::string("1 ") + word + " 3\n4 5 6\n");
    EXPECT_TRUE(std::isnan(values[4])) << word << ' ' << values[4];
  }
}

TEST(TextGrid, AWordIsRefusedWithItsLine) {
  for (const char* word : {"abc", "NA", "x", "--", "0x7f", "12abc", "1,5,2", "1.5.2", "null", "+-3", "*"}) {
    const std::string text = std::string("1 2 3\n4 ") + word + " 6\n";
    EXPECT_THAT(refusal([&] { heights(text); }),
                HasSubstr("g.asc:8: '" + std::string(word) + "' is not a number"));
  }
  const TemporaryFolder folder;
  refuseWordsInGrid(folder.write("h.asc", "ncols 1\nnrows 1\nNODATA_value nan\ncellsize 1\n7"));
  EXPECT_THAT(
      refusal([&] { refuseWordsInGrid(folder.write("l.asc", "ncols 1\n" + std::string(9000, '1'))); }),
      HasSubstr("l.asc:2: '1111"));
}

TEST(TextGrid, ClassesAndRocksAreHeldToTheSame) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);  // four by three cells
  const std::string header = "ncols 4\nnrows 3\nxllcorner 500000\nyllcorner 4999970\ncellsize 10\n";
  const std::string words = folder.write("c.asc", header + "0 1 nan 1\n0 1 1 1\n0 0 0 0\n");
  EXPECT_EQ(drawing(readTerrainClasses({.path = words}, dem)), "01.1\n0111\n0000\n");
  const std::string junk = folder.write("j.asc", header + "0 1 road 1\n0 1 1 1\n0 0 0 0\n");
  EXPECT_THROW(readTerrainClasses({.path = junk}, dem), InputError);
  EXPECT_THROW(readRockAbundance({.path = junk}, dem), InputError);
}

}  // namespace text_grid_test
}  // namespace talus::maps
