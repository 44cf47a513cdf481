#include <nlohmann/json.hpp>

#include <talus/cli/ground/file_formats.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace help_command_test {

using testing::HasSubstr;

TEST(HelpCommand, FormatsAreTheKeysOfTheReaders) {
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

TEST(HelpCommand, ACallsHelpIsThatOfTheCallAndAnUnknownTopicOneLine) {
  EXPECT_EQ(runTalus({"help", "plan"}).out, runTalus({"plan", "--help"}).out);
  EXPECT_EQ(runTalus({"help"}).out, runTalus({"--help"}).out);
  const Ran unknown = runTalus({"help", "format"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_EQ(unknown.err, "talus: format: is no topic of help; did you mean formats?\n");
}

}  // namespace help_command_test
}  // namespace talus::cli
