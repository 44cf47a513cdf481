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

// Property: manual and completion script contain every subcommand and option; bash accepts the script.
TEST(HelpCommand, ManualAndCompletionCoverEveryCommand) {
  const Folder folder;
  const std::string manual = runTalus({"help", "man"}).out,
                    script = runTalus({"help", "bash-completion"}).out;
  EXPECT_THAT(runTalus({"help"}).out, HasSubstr("talus help man, talus help bash-completion"));
  for (const char* call : {"plan", "doctor", "wheel", "help"}) {
    EXPECT_THAT(manual, HasSubstr(std::string("\n.SS talus ") + call + "\n")) << call;
    EXPECT_THAT(script, HasSubstr(std::string("\n    ") + call + ") options='--")) << call;
  }
  // Requirements of mandoc -Tlint: a date, and no line longer than 80 bytes.
  EXPECT_TRUE(std::regex_search(manual, std::regex("^\\.TH TALUS 1 [0-9]{4}-[0-9]{2}-[0-9]{2} ")));
  std::istringstream lines(manual);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
  EXPECT_THAT(manual, HasSubstr("\\fIKNOWN=NAME[:UNIT]"));
  EXPECT_THAT(manual, HasSubstr("\\fB\\-\\-keep\\-out\\fR \\fIFILE\\fR\n"));
  folder.write("talus.bash", script +
                                 "COMP_WORDS=(talus estimate t.csv --method soj) COMP_CWORD=4\n_talus\n"
                                 "echo \"${COMPREPLY[*]}\"\nCOMP_WORDS=(talus pl) COMP_CWORD=1\n_talus\n"
                                 "echo \"${COMPREPLY[*]}\"\n");
  const std::string command = "bash " + (folder / "talus.bash") + " > " + (folder / "out");
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(fileContent(folder / "out"), "sojourner\nplan plugins\n");
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
