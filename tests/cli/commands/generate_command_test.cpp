#include <regex>

#include <nlohmann/json.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace generate_command_test {

using testing::HasSubstr;

TEST(GenerateCommand, GeneratedSiteIsReadByOtherCommands) {
  const Folder folder;
  const Ran ran = runTalus({"generate", "craters", "--size", "80x60", "--resolution", "2", "--seed", "4",
                            "-o", folder / "site.tif"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(folder.names(),
            (std::vector<std::string>{"site.tif", "site_classes.tif", "site_rocks.tif", "site_soils.yaml"}));
  const Ran info = runTalus({"info", folder / "site.tif", "--json"});
  ASSERT_EQ(info.code, 0) << info.err;
  const auto json = nlohmann::json::parse(info.out);
  EXPECT_EQ(json["width"], 80);
  EXPECT_EQ(json["height"], 60);
  EXPECT_EQ(json["resolution_m"], 2.0);
  EXPECT_EQ(json["body"], "Moon");
  const std::string first = fileContent(folder / "site.tif");
  runTalus({"generate", "craters", "--size", "80x60", "--resolution", "2", "--seed", "4", "--threads", "2",
            "-o", folder / "site.tif"});
  EXPECT_EQ(fileContent(folder / "site.tif"), first) << "same seed, same bytes";
}

// Property: at most one cell in a thousand of a generated rock layer is treated as lost data.
TEST(GenerateCommand, GeneratedRocksAreNotTreatedAsLostData) {
  const Folder folder;
  for (const std::string kind : {"craters", "dunes", "rocks"}) {
    const Ran made = runTalus({"generate", kind, "--size", "150", "--seed", "31", "-o", folder / "s.tif"});
    ASSERT_EQ(made.code, 0) << made.err;
    const Ran ran = runTalus({"costmap", folder / "s.tif", "--terrain", folder / "s_classes.tif", "--soils",
                              folder / "s_soils.yaml", "--rocks", folder / "s_rocks.tif", "--rover", "mer",
                              "-o", folder / "s.ot"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    std::smatch unseen;
    if (std::regex_search(ran.err, unseen, std::regex("layer rocks has no data in ([0-9]+) of"))) {
      EXPECT_LE(std::stoi(unseen[1]), 22) << kind;
    }
  }
}

}  // namespace generate_command_test
}  // namespace talus::cli
