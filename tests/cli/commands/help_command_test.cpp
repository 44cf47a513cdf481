#include <cstdlib>
#include <regex>
#include <sstream>

#include <nlohmann/json.hpp>

#include <talus/cli/ground/file_formats.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace help_command_test {

using testing::HasSubstr;

TEST(HelpCommand, FormatsListTheKeysOfTheReaders) {
  const Ran ran = runTalus({"help", "formats"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.out, formatsText());
  EXPECT_THAT(ran.out, HasSubstr("\n  cohesion_Pa "));
  const Ran json = runTalus({"help", "formats", "--json"});
  ASSERT_EQ(json.code, 0) << json.err;
  const auto formats = nlohmann::json::parse(json.out)["formats"];
  for (const FileFormat& format : fileFormats())
    EXPECT_EQ(formats[format.title].size(), format.keys.size()) << format.title;
}

TEST(HelpCommand, SoilsAndRoversListTheLibrary) {
  const std::string soils = runTalus({"help", "soils"}).out, rovers = runTalus({"help", "rovers"}).out;
  for (const std::string& name : terramech::librarySoils())
    EXPECT_THAT(soils, HasSubstr("\n" + name + " ")) << name;
  for (const std::string& name : terramech::libraryRovers())
    EXPECT_THAT(rovers, HasSubstr("\n" + name + " ")) << name;
}

TEST(HelpCommand, ManualCoversEveryCommand) {
  const std::string manual = runTalus({"help", "man"}).out;
  EXPECT_THAT(runTalus({"help"}).out, HasSubstr("talus help man"));
  for (const char* call : {"plan", "doctor", "wheel", "help"})
    EXPECT_THAT(manual, HasSubstr(std::string("\n.SS talus ") + call + "\n")) << call;
  // Requirements of mandoc -Tlint: a date, and no line longer than 80 bytes.
  EXPECT_TRUE(std::regex_search(manual, std::regex("^\\.TH TALUS 1 [0-9]{4}-[0-9]{2}-[0-9]{2} ")));
  std::istringstream lines(manual);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
  EXPECT_THAT(manual, HasSubstr("\\fIKNOWN=NAME[:UNIT]"));
  EXPECT_THAT(manual, HasSubstr("\\fB\\-\\-keep\\-out\\fR \\fIFILE\\fR\n"));
}

// Property: the script completes calls, options of a call and the choices of an option, as the help lists them.
TEST(HelpCommand, CompletionFollowsTheHelp) {
  const Folder folder;
  const auto completions = [&](const std::string& words) {
    const std::string out = folder / "out",
                      of = TALUS_SOURCE_DIR "/cli/completion/talus.bash " TALUS_PROGRAM " ";
    return std::system(("bash " + of + words + " > " + out).c_str()) == 0 ? fileContent(out) : "failed";
  };
  EXPECT_EQ(completions("estimate t.csv --method soj"), "sojourner\n");
  EXPECT_EQ(completions("pl"), "plan\nplugins\n");
  EXPECT_EQ(completions("plan --no-"), "--no-marginal\n--no-proof\n--no-reverse\n");
  EXPECT_EQ(completions("drive dem.tif --belief pe"), "perfect-knowledge\n");
}

TEST(HelpCommand, HelpOfACommandEqualsItsHelpOptionAndUnknownTopicIsOneLine) {
  EXPECT_EQ(runTalus({"help", "plan"}).out, runTalus({"plan", "--help"}).out);
  EXPECT_EQ(runTalus({"help"}).out, runTalus({"--help"}).out);
  const Ran unknown = runTalus({"help", "format"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_EQ(unknown.err, "talus: format: is no topic of help; did you mean formats?\n");
}

}  // namespace help_command_test
}  // namespace talus::cli
