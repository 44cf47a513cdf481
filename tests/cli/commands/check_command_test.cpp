#include <nlohmann/json.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace check_command_test {

using nlohmann::json;
using testing::HasSubstr;

TEST(CheckCommand, ReferenceCasesPassAndKnownFailuresAreNamed) {
  const Ran ran = runTalus({"check", TALUS_SOURCE_DIR "/examples/checks/reference.yaml", "--json"});
  EXPECT_EQ(ran.code, 0) << ran.out;
  const json answer = json::parse(ran.out);
  EXPECT_EQ(answer["passed"], 4);
  EXPECT_EQ(answer["known_failures"].size(), 1u);
}

// Each way to be wrong: a number, a text, an exit code, a value that is missing, a known failure that passes.
TEST(CheckCommand, WrongAnswersFailWithWhatWasFound) {
  const Folder folder;
  const auto failures = [&](const std::string& more) {
    folder.write(
        "cases.yaml",
        "cases:\n  - {name: one, operation: wheel, input: {soil: dry_sand, rover: mer, slip: 0.2}, " + more +
            "}\n");
    const Ran ran = runTalus({"check", "cases.yaml", "--json"}, folder.path());
    const json answer = json::parse(ran.out);
    EXPECT_EQ(ran.code, answer["failed"].empty() ? 0 : 1);
    return answer["failed"].size();
  };
  EXPECT_EQ(failures("expect: {exit: 0}"), 0u);
  EXPECT_EQ(failures("expect: {exit: 2}"), 1u);
  EXPECT_EQ(failures("expect: {sinkage_m: 5}"), 1u);
  EXPECT_EQ(failures("expect: {sinkage_m: 5}, tolerance: 5"), 0u);
  EXPECT_EQ(failures("expect: {sinkage_m: deep}"), 1u);
  EXPECT_EQ(failures("expect: {nothing.here: 1}"), 1u);
  EXPECT_EQ(failures("expect: {sinkage_m: 5}, known_failure: true"), 0u);
  EXPECT_EQ(failures("expect: {exit: 0}, known_failure: true"), 1u);
  folder.write("cases.yaml", "cases:\n  - {name: one, operation: wheel, expects: {exit: 0}}\n");
  const Ran ran = runTalus({"check", "cases.yaml"}, folder.path());
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("expects"));
}

}  // namespace check_command_test
}  // namespace talus::cli
