#include <set>

#include <talus/cli/app/command.hpp>
#include <talus/cli/app/commands.hpp>

namespace talus::cli {
namespace commands_test {

// Property: every subcommand has a unique name, a group known to --help, and parses its own --help.
TEST(Commands, EachCommandHasANameGroupAndExamples) {
  CLI::App app("talus");
  Context context;
  addCommands(app, context);
  const std::set<std::string> groups{Group::kRoutes, Group::kMaps, Group::kSoil, Group::kHelp};
  std::set<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    EXPECT_TRUE(names.insert(command->get_name()).second) << command->get_name();
    EXPECT_TRUE(groups.contains(command->get_group())) << command->get_name();
    EXPECT_THAT(command->get_footer(), testing::HasSubstr("talus " + command->get_name()));
  }
  // Subcommands of the stable interface.
  for (const char* promised : {"info", "wheel", "estimate", "assess", "trace", "predict", "costmap", "update",
                               "plan", "score", "explain", "drive", "bench", "check", "view", "plugins"})
    EXPECT_TRUE(names.contains(promised)) << promised;
}

}  // namespace commands_test
}  // namespace talus::cli
