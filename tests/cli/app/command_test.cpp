#include <string>

#include <talus/cli/app/command.hpp>

namespace talus::cli {
namespace command_test {

struct Options {
  std::string name;
  int count = 2;
};

void bind(CLI::App& command, Options& options) {
  command.add_option("--name", options.name)->required();
  command.add_option("--count", options.count)->capture_default_str();
}

int run(const Options& options, Context& context) {
  return options.name == "no" ? Exit::kNo : options.count + (context.quiet ? 10 : 20);
}

struct Program {
  CLI::App app{"test"};
  Context context;

  Program() {
    context.quiet = true;
    addCommand<Options>(
        app, context,
        {.name = "greet", .group = Group::kMaps, .description = "greets", .examples = "  talus greet\n"},
        bind, run);
  }
};

// Closed form: run() returns 10 + count, which becomes the exit code of the program.
TEST(Command, ParsedOptionsAreUsedAndTheExitCodeKept) {
  Program program;
  program.app.parse("greet --name x --count 5");
  EXPECT_EQ(program.context.exit_code, 15);
  Program refusing;
  refusing.app.parse("greet --name no");
  EXPECT_EQ(refusing.context.exit_code, Exit::kNo);
}

TEST(Command, InvalidCommandLineDoesNotRun) {
  Program program;
  program.context.exit_code = 99;
  EXPECT_THROW(program.app.parse("greet"), CLI::RequiredError);
  EXPECT_THROW(program.app.parse("greet --name x --count many"), CLI::ConversionError);
  EXPECT_EQ(program.context.exit_code, 99);
}

}  // namespace command_test
}  // namespace talus::cli
