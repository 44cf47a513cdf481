#include <sstream>

#include <talus/cli/app/help_format.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace help_format_test {

using testing::HasSubstr;

// Property: word order is kept, no line exceeds the width unless a single word does, and each line is full.
TEST(HelpFormat, TextIsWrappedAtSpaces) {
  const std::string text =
      "a rover drives over  soft ground\nand an-overlong-word-stays-whole on its own line";
  for (const std::size_t width : {8U, 12U, 20U, 200U}) {
    std::istringstream lines(wrapped(text, width));
    std::string joined, before(width, 'x');
    for (std::string line; std::getline(lines, line);) {
      EXPECT_TRUE(line.size() <= width || line.find(' ') == std::string::npos) << line;
      EXPECT_GT(before.size() + 1 + line.substr(0, line.find(' ')).size(), width);
      joined += (joined.empty() ? "" : " ") + line;
      before = line;
    }
    EXPECT_EQ(joined, "a rover drives over soft ground and an-overlong-word-stays-whole on its own line");
  }
  EXPECT_EQ(wrapped("", 10), "");
}

TEST(HelpFormat, OptionHelpShowsValueChoicesDefaultAndExclusions) {
  CLI::App app("purpose", "talus");
  app.formatter(std::make_shared<HelpFormat>());
  std::string kind = "rigid";
  int side = 5;
  bool fast = false;
  auto* first = app.add_option("--kind", kind, "of chassis")
                    ->type_name("KIND")
                    ->check(CLI::IsMember({"rigid", "rocker"}));
  app.add_option("--side", side, "in cells")
      ->type_name("N")
      ->check(CLI::Range(1, 9))
      ->capture_default_str()
      ->excludes(first);
  app.add_flag("--fast", fast, "hurry");
  groupOptions(app, "Ground");
  const std::string help = app.help();
  EXPECT_THAT(help, HasSubstr("\nGround:\n"));
  EXPECT_THAT(help, HasSubstr("--kind KIND"));
  EXPECT_THAT(help, HasSubstr("of chassis [one of rigid, rocker; not with --side]"));
  EXPECT_THAT(help, HasSubstr("in cells [1 to 9; default: 5; not with --kind]"));
}

}  // namespace help_format_test
}  // namespace talus::cli
