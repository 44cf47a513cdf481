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
  EXPECT_EQ(json["interface_version"], 9);
  EXPECT_EQ(json["planners"][0], "field");
  EXPECT_THAT(json["features"], ::testing::Contains("lower bound"));
}

}  // namespace plugins_command_test
}  // namespace talus::cli
