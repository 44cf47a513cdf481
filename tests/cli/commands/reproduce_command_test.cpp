#include <cstdlib>

#include <nlohmann/json.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace reproduce_command_test {

using nlohmann::json;
using testing::HasSubstr;

TEST(ReproduceCommand, GoalsAreReproducibleForTheSameSeed) {
  // Property: all lines but those of processor time are reproducible.
  const auto measured = [] {
    const Ran ran = runTalus({"--json", "--seed", "5", "reproduce", "--goals", "--soils", "8"});
    EXPECT_EQ(ran.code, 0) << ran.err;
    json lines = json::parse(ran.out);
    json kept = json::array();
    for (const json& line : lines) {
      if (!line["quantity"].get<std::string>().starts_with("processor time")) kept.push_back(line);
    }
    return kept;
  };
  const json once = measured();
  EXPECT_GT(once.size(), 20u);
  EXPECT_EQ(once, measured());
}

// Routes within 0.2 % of closed forms and no dearer than those of CAMIS; slips of a rover on a tilt bed, of which no
// parameter is fitted, within 0.1 to 15.3 degrees.
TEST(ReproduceCommand, PublishedResultsAreRebuilt) {
  const auto lines = [](const std::string& name) {
    const Ran ran = runTalus({"--json", "reproduce", "--published", name});
    EXPECT_EQ(ran.code, 0) << ran.err;
    return json::parse(ran.out);
  };
  for (const json& line : lines("rowe-ross")) EXPECT_NEAR(line["error"], 0.0, 0.002) << line;
  for (const json& line : lines("camis")) EXPECT_LE(line["error"], 0.0) << line;
  const json slips = lines("mgru3");
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(slips[k]["error"], 0.0, 0.1) << slips[k];
  EXPECT_EQ(runTalus({"reproduce", "--published", "nothing"}).code, 2);
}

TEST(ReproduceCommand, PageAndEveryFigureAreWritten) {
  const Folder folder;
  const Ran ran = runTalus({"reproduce", "--soils", "8", "-o", folder / "docs"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::string page = fileContent(folder / "docs/validation.md");
  for (const char* figure :
       {"2_5", "2_6", "2_7", "2_9", "3_5", "3_6", "3_8", "3_12", "A_4", "C_4", "D_1", "D_2", "D_3"}) {
    const std::string picture = std::string("validation/figure_") + figure + ".png";
    EXPECT_THAT(page, HasSubstr(picture));
    EXPECT_GT(fileContent(folder / ("docs/" + picture)).size(), 1000u) << picture;
  }
}

TEST(ReproduceCommand, FolderThatCannotBeCreatedIsRejected) {
  const Folder folder;
  const std::string file = folder.write("file", "x");
  const Ran ran = runTalus({"reproduce", "--soils", "8", "-o", file + "/below"});
  EXPECT_EQ(ran.code, 2);
}

TEST(ReproduceCommand, MissingValidationProgramIsReportedWithARemedy) {
  const Folder folder;
  std::filesystem::copy_file(TALUS_PROGRAM, folder / "talus");
  const std::string line = "cd '" + folder.path().string() + "' && ./talus reproduce --goals >out 2>err";
  const int status = std::system(line.c_str());  // NOLINT(cert-env33-c): the shell redirects the output
  EXPECT_EQ(WEXITSTATUS(status), 2);
  EXPECT_EQ(fileContent(folder / "out"), "");
  EXPECT_EQ(fileContent(folder / "err"),
            "talus: " + (folder / "talus-reproduce") +
                ": the program that reproduces the thesis is not there; build the target talus_reproduce, or "
                "install talus again\n");
}

}  // namespace reproduce_command_test
}  // namespace talus::cli
