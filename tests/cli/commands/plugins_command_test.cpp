#include <nlohmann/json.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace plugins_command_test {

using testing::HasSubstr;

TEST(PluginsCommand, BuiltInAndPluginCapabilitiesAreListed) {
  const Ran built_in = runTalus({"plugins"});
  EXPECT_EQ(built_in.code, 0) << built_in.err;
  EXPECT_THAT(built_in.out, HasSubstr("planners: field, hybrid, RRTstar"));
  const Ran loaded = runTalus({"plugins", TALUS_PLUGIN, "--json"});
  ASSERT_EQ(loaded.code, 0) << loaded.err;
  const auto json = nlohmann::json::parse(loaded.out);
  EXPECT_EQ(json["name"], "talus");
  EXPECT_EQ(json["interface_version"], 8);
  EXPECT_EQ(json["planners"][0], "field");
  EXPECT_THAT(json["features"], ::testing::Contains("lower bound"));
}

TEST(PluginsCommand, FilesThatAreNoPluginAreRejectedWithOneLine) {
  const Folder folder;
  for (const std::string& file : {folder / "none.so", folder.write("text.so", "not a library\n")}) {
    const Ran ran = runTalus({"plugins", file});
    EXPECT_EQ(ran.code, 2);
    EXPECT_THAT(ran.err, HasSubstr(file));
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  }
}

}  // namespace plugins_command_test
}  // namespace talus::cli
