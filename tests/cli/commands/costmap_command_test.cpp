#include <nlohmann/json.hpp>

#include "bad_input.hpp"

namespace talus::cli {
namespace costmap_command_test {

using nlohmann::json;

// Level terrain with a block of 2 m height, which no rover can climb.
double block(int column, int row) {
  return column >= 20 && column < 24 && row >= 10 && row < 14 ? 2.0 : 0.0;
}

json run(const Folder& folder, std::vector<std::string> words) {
  words.insert(words.begin(), {"--json", "--quiet", "costmap"});
  const Ran ran = runTalus(words, folder.path());
  EXPECT_EQ(ran.code, 0) << ran.err;
  return json::parse(ran.out, nullptr, false);
}

// Property: the categories sum to the number of cells, a map read from its file has the same counts, and
// stricter thresholds do not increase the safe area.
TEST(CostmapCommand, CategoriesCountEveryCellAndRoundTrip) {
  const Folder folder;
  folder.write("dem.asc", asciiGrid(50, 40, block));
  const std::vector<std::string> ground{"dem.asc",    "--resolution", "1",  "--soil",
                                        "sandy_loam", "--rover",      "mer"};
  const auto with = [&ground](const std::vector<std::string>& more) { return joined(ground, more); };
  const json built = run(folder, with({"-o", "map.ot", "--octovis", "colour.ot", "--geotiff", "layers.tif"}));
  const auto count = [](const json& of, const char* category) {
    return of["categories"][category].get<int>();
  };
  EXPECT_EQ(built["cells"], 2000);
  EXPECT_EQ(
      count(built, "safe") + count(built, "marginal") + count(built, "dangerous") + count(built, "unknown"),
      2000);
  EXPECT_GT(count(built, "safe"), 1500);
  EXPECT_GT(count(built, "dangerous"), 16);  // the block and the cells whose footprint touches it
  EXPECT_EQ(built["rover"], "mer");
  EXPECT_EQ(run(folder, {"map.ot"})["categories"], built["categories"]);
  const json strict = run(folder, with({"--slope-uncertainty-deg", "20"}));
  EXPECT_LE(count(strict, "safe"), count(built, "safe"));
  // Printed in: specifications of OctoMap files and TIFF 6.0, first bytes of a file.
  EXPECT_THAT(fileContent(folder / "colour.ot"), testing::HasSubstr("id ColorOcTree"));
  EXPECT_THAT(fileContent(folder / "map.ot"), testing::HasSubstr("id TraversabilityTree"));
  EXPECT_THAT(fileContent(folder / "layers.tif"), testing::StartsWith("II"));
}

}  // namespace costmap_command_test
}  // namespace talus::cli
