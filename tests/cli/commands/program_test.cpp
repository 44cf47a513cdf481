#include <cstdlib>

#include <sys/wait.h>

#include <talus/cli/app/commands.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace program_test {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// An invalid call: its arguments, and a part of the error line.
struct WrongCall {
  std::vector<std::string> words;
  std::string says;

  friend void PrintTo(const WrongCall& call, std::ostream* os) { *os << testing::PrintToString(call.words); }
};

class WrongCalls : public testing::TestWithParam<WrongCall> {};

TEST_P(WrongCalls, ErrorIsOneLineWithCodeTwo) {
  const Ran ran = runTalus(GetParam().words);
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, StartsWith("talus: "));
  EXPECT_THAT(ran.err, HasSubstr(GetParam().says));
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  EXPECT_THAT(ran.out, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    Program, WrongCalls,
    testing::Values(WrongCall{{}, "no subcommand; see talus --help"},
                    WrongCall{{"xyzzy"}, "unknown subcommand 'xyzzy'"},
                    WrongCall{{"--thread", "2"}, "unknown option '--thread', did you mean '--threads'?"},
                    WrongCall{{"--seed", "many"}, "--seed"}, WrongCall{{"--threads", "0"}, "--threads"},
                    WrongCall{{"plan", "x.tif", "--risk-weight", ""}, "--risk-weight: its value is empty"},
                    WrongCall{{"plan", "--map=", "x.tif"}, "--map: its value is empty"},
                    WrongCall{{"info", "x.tif", "--seed", "0x10"}, "must be decimal"},
                    WrongCall{{"info", "x.tif", "--threads", "0x10"}, "must be decimal"},
                    WrongCall{{"info", "x.tif", "--max-memory", "0x1GB"}, "must be a whole decimal number"},
                    WrongCall{{"info", "x.tif", "--max-memory", "1e"}, "must be a whole decimal number"}));

TEST(Program, HelpAndVersionGoToStandardOutput) {
  EXPECT_THAT(runTalus({"--version"}).out, StartsWith("talus "));
  const Ran help = runTalus({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.out, HasSubstr("Usage: talus"));
  EXPECT_THAT(help.err, IsEmpty());
}

// If stdout is a closed pipe, as behind `head`, the program ends silently; a full device is an error.
TEST(Program, ClosedPipeIsNoErrorAndFullDeviceIs) {
  const Folder folder;
  const std::string call = "cd '" + folder.path().string() + "' && { sleep 0.3; '" + TALUS_PROGRAM +
                           "' plan --help 2>err; echo $? >code; } | true; sleep 1";
  EXPECT_EQ(std::system(call.c_str()), 0);
  EXPECT_EQ(fileContent(folder / "code"), "141\n");
  EXPECT_EQ(fileContent(folder / "err"), "");
  const std::string full =
      "'" + std::string(TALUS_PROGRAM) + "' plan --help >/dev/full 2>'" + (folder / "full") + "'";
  EXPECT_EQ(WEXITSTATUS(std::system(full.c_str())), 2);
  EXPECT_THAT(fileContent(folder / "full"), HasSubstr("standard output: cannot be written"));
}

}  // namespace program_test
}  // namespace talus::cli
