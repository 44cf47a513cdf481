#include <cmath>

#include <CLI/CLI.hpp>

#include <talus/cli/ground/map_options.hpp>
#include <talus/common/input_error.hpp>

#include "bad_input.hpp"

namespace talus::cli {
namespace map_options_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

double ramp(int column, int row) {
  return column + 100.0 * row;
}

ElevationFile parsed(const std::string& line) {
  CLI::App app;
  ElevationFile options;
  addMapOptions(app, options);
  app.parse(line);
  return options;
}

// Closed form: elevation as a function of column and row; with a window, only cells inside the window are
// read.
TEST(MapOptions, ElevationFollowsTheReadOptions) {
  const Folder folder;
  const std::string dem = folder.write("dem.asc", asciiGrid(12, 9, ramp));
  const auto whole = readMap(parsed(dem + " --resolution 1"));
  EXPECT_EQ(whole.grid().width, 12);
  EXPECT_NEAR((whole.elevation_m[{5, 3}]), 305.0, 1e-4);
  const auto part = readMap(parsed(dem + " --resolution 1 --window 2,3,6,8"));
  EXPECT_EQ(part.grid().width, 4);
  EXPECT_EQ(part.grid().height, 5);
  EXPECT_NEAR((part.elevation_m[{0, 0}]), 302.0, 1e-4);
  const auto scaled = readMap(parsed(dem + " --resolution 1 --vertical-scale 0.5 --nodata 7"));
  EXPECT_NEAR((scaled.elevation_m[{5, 3}]), 152.5, 1e-4);
  EXPECT_TRUE(std::isnan(scaled.elevation_m[{7, 0}]));
}

TEST(MapOptions, InvalidReadOptionsAreRejected) {
  const Folder folder;
  const std::string dem = folder.write("dem.asc", asciiGrid(12, 9, ramp));
  EXPECT_THAT([&] { readMap(parsed(dem + " --resolution 1 --below 3")); },
              ThrowsMessage<InputError>(HasSubstr("remove --below")));
  EXPECT_THAT([&] { readMap(parsed(dem + " --resolution 1 --max-cells 50")); },
              ThrowsMessage<InputError>(HasSubstr("12 x 9 cells are too many")));
  for (const char* count : {"-1", "0", "1e300"})
    EXPECT_THROW(parsed(dem + " --max-cells " + count), CLI::ParseError) << count;
  EXPECT_THROW(parsed("--band 1"), CLI::RequiredError);
}

// Closed form: two keep-out squares block the cells of both; layers without a file stay empty.
TEST(MapOptions, KeepOutFilesAreCombined) {
  const Folder folder;
  const auto square = [&folder](const std::string& name, int x) {
    const std::string a = std::to_string(x) + ".2", b = std::to_string(x) + ".8";
    return folder.write(name, R"({"type":"Polygon","crs":"local","coordinates":[[[)" + a + ",1.2],[" + b +
                                  ",1.2],[" + b + ",1.8],[" + a + ",1.8],[" + a + ",1.2]]]}");
  };
  SiteFiles files{.elevation = folder.write("dem.asc", asciiGrid(12, 9, ramp))};
  files.elevation.read.resolution_m = 1.0;
  files.keep_out = {square("a.json", 2), square("b.json", 7)};
  const costmap::MapLayers layers = readSite(files).layers;
  EXPECT_TRUE(layers.classes.empty() && layers.rock_abundance.empty());
  for (int row = 0; row < 9; ++row)
    for (int column = 0; column < 12; ++column)
      EXPECT_EQ((layers.keep_out[{column, row}]) != 0, row == 1 && (column == 2 || column == 7));
}

}  // namespace map_options_test
}  // namespace talus::cli
