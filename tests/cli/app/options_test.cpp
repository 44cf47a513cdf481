#include <sstream>

#include <talus/cli/app/commands.hpp>
#include <talus/cli/app/context.hpp>
#include <talus/cli/app/options.hpp>
#include <talus/common/common.hpp>

#include "run_program.hpp"

namespace talus::cli {

namespace options_test {

TEST(NumberCheck, NanInfinityAndOutOfRangeAreRejected) {
  CLI::Validator slip = within(-1.0, 1.0);
  for (std::string good : {"-1", "0", "0.999", "1"}) EXPECT_EQ(slip(good), "");
  for (std::string bad : {"1.001", "nan", "-inf", "abc", ""}) EXPECT_NE(slip(bad), "");
  std::string two = "2";
  EXPECT_EQ(slip(two), "2, must be -1 to 1");
  std::string one = "1";
  EXPECT_EQ(within(1e-12, 1.0 - 1e-12)(one), "1, must be 1e-12 to 0.999999999999");
}

// The error of checkNumbers() for a parsed line; empty if it accepts the line.
std::string refusal(const std::string& line) {
  CLI::App app;
  std::string value, map;
  double weight = 0.0;
  app.add_option("--risk", value);
  app.add_option("--time-weight", weight);
  app.add_option("--map", map)->type_name("MAP.ot");
  app.parse(line);
  try {
    checkNumbers(app);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

// Implausible numbers are refused for every option, because range tests accept NaN.
TEST(NumberCheck, ImpossibleNumbersAreRejectedForAnyOption) {
  for (const char* bad :
       {"nan", "-nan", "NaN", "inf", "-Infinity", "1e999", "1e-300", "1e300", "5,nan", "nand,3d"})
    EXPECT_THAT(refusal(std::string("--risk=") + bad), testing::HasSubstr("--risk ")) << bad;
  for (const char* other : {"0x10", "-0X1p3", "010", "5,0x10", "-007"})
    EXPECT_THAT(refusal(std::string("--risk=") + other), testing::HasSubstr("must be decimal")) << other;
  for (const char* good : {"0.10", "0xfile", "00.tif", "0", "0.5", "-3", "18446744073709551615", "x.tif",
                           "nano.tif", "./nan", "3d,4d", "1e-9"})
    EXPECT_EQ(refusal(std::string("--risk=") + good), "") << good;
  // A file may be named like a number.
  EXPECT_THAT(refusal("--time-weight 1e300"), testing::EndsWith("give another number"));
  EXPECT_THAT(refusal("--map 1e300"), testing::EndsWith("a file of that name is ./1e300"));
}

// Property: without this check the parser reads `--risk-weight ""` as 0 and `--map ""` as no map.
TEST(NumberCheck, EmptyValuesAreRejectedForEveryOption) {
  using Words = std::vector<std::string>;
  Context context;
  const auto declare = [&context](CLI::App& app) {
    app.add_option("--seed", context.seed);
    addCommands(app, context);
    refuseEmptyValues(app);
  };
  const auto said = [&](const std::string& command, const Words& words) -> std::string {
    CLI::App app("talus");
    app.fallthrough();
    declare(app);
    std::vector<std::string> reversed(words.rbegin(), words.rend());
    reversed.push_back(command);
    try {
      app.parse(reversed);
    } catch (const InputError& e) {
      return e.what();
    } catch (const CLI::ParseError& e) {
      return std::string("no InputError: ") + e.what();
    }
    return "";
  };
  CLI::App app("talus");
  declare(app);
  std::size_t asked = 0;
  for (const CLI::App* command : app.get_subcommands({}))
    for (const CLI::Option* option : command->get_options()) {
      EXPECT_FALSE(option->get_description().empty()) << command->get_name() << " " << option->get_name(true);
      if (option->get_items_expected_max() == 0) continue;
      ++asked;
      const bool named = !option->get_lnames().empty();
      const std::string name = named ? "--" + option->get_lnames().front() : option->get_name(true);
      for (const char* empty : {"", "\t "})
        EXPECT_THAT(said(command->get_name(), named ? Words{name, empty} : Words{empty}),
                    testing::HasSubstr(": its value is empty; "))
            << command->get_name() << " " << name;
    }
  EXPECT_GT(asked, 200U);
  EXPECT_EQ(said("info", {"--seed", "", "x.tif"}),
            "--seed: its value is empty; leave the option out or give a value");
}

TEST(NumberCheck, FiniteNonNegativeAndPositiveChecksRejectOtherNumbers) {
  std::string minus = "-3";
  std::string none = "nan";
  EXPECT_EQ(finite()(minus), "");
  EXPECT_EQ(notNegative()(minus), "-3, must be finite, >= 0");
  for (std::string bad : {"0", "-1", "nan", "inf", "x"})
    EXPECT_EQ(positive()(bad), bad + ", must be finite, > 0");
  std::string little = "1e-300";
  EXPECT_EQ(positive()(little), "");
  EXPECT_EQ(finite()(none), "nan, must be a finite number");
}

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
  first->group("Ground");
  const std::string help = app.help();
  EXPECT_THAT(help, HasSubstr("\nGround:\n"));
  EXPECT_THAT(help, HasSubstr("--kind KIND"));
  EXPECT_THAT(help, HasSubstr("of chassis [one of rigid, rocker; not with --side]"));
  EXPECT_THAT(help, HasSubstr("in cells [1 to 9; default: 5; not with --kind]"));
}

}  // namespace options_test

}  // namespace talus::cli
