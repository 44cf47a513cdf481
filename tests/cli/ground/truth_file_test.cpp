#include <talus/cli/ground/truth_file.hpp>
#include <talus/common/common.hpp>
#include <talus/terramech/io/terramech_io.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace truth_file_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

planner::Truth read(const std::string& text) {
  const Folder folder;
  return readTruth(folder.write("truth.yaml", text));
}

TEST(TruthFile, EveryPartIsOptional) {
  const planner::Truth truth = read("{}\n");
  EXPECT_TRUE(truth.classes.empty() && truth.patches.empty() && truth.effects.empty());
  EXPECT_EQ(truth.spread, 0.0);
  EXPECT_EQ(truth.random_patches, 0);
  EXPECT_EQ(truth.patch_soil.name, terramech::loadSoil("mars_drift").name);
}

TEST(TruthFile, EveryFieldIsRead) {
  const planner::Truth truth = read(
      "classes: {1: dry_sand, 4: sandy_loam}\n"
      "patches: [{x_m: 40, y_m: 25, radius_m: 4, soil: dry_sand},\n"
      "          {x_cm: 100, y_m: -3, radius_m: 2, soil: sandy_loam}]\n"
      "random: {spread: 0.1, patches: 8, patch_radius_m: 2.5, patch_soil: dry_sand}\n"
      "effects: [{name: slip_sinkage_ding, parameters: [0.4]}]\n");
  ASSERT_EQ(truth.classes.size(), 2U);
  EXPECT_EQ(truth.classes.at(4).cohesion_Pa, terramech::loadSoil("sandy_loam").cohesion_Pa);
  ASSERT_EQ(truth.patches.size(), 2U);
  EXPECT_EQ(truth.patches[0].centre, (maps::Point{40, 25}));
  EXPECT_EQ(truth.patches[0].radius_m, 4.0);
  EXPECT_EQ(truth.patches[1].centre, (maps::Point{1, -3}));
  EXPECT_EQ(truth.patches[1].soil.name, terramech::loadSoil("sandy_loam").name);
  EXPECT_EQ(truth.spread, 0.1);
  EXPECT_EQ(truth.random_patches, 8);
  EXPECT_EQ(truth.patch_radius_m, 2.5);
  EXPECT_EQ(truth.patch_soil.name, terramech::loadSoil("dry_sand").name);
  ASSERT_EQ(truth.effects.size(), 1U);
  EXPECT_EQ(truth.effects[0].parameters, (std::vector<double>{0.4}));
}

TEST(TruthFile, ErrorsNameTheField) {
  const std::pair<const char*, const char*> cases[] = {
      {"random: {spread: 1.5}\n", "spread must lie in [0, 1]"},
      {"random: {spread: .nan}\n", "spread"},
      {"random: {patches: -1}\n", "patches must lie in"},
      {"random: {patch_radius_m: 0}\n", "patch_radius_m must be > 0"},
      {"patches: [{x_m: .inf, y_m: 2, radius_m: 3, soil: dry_sand}]\n", "x_m"},
      {"patches: [{x_m: 1, y_m: 2, radius_m: -3, soil: dry_sand}]\n", "radius_m must be > 0"},
      {"patches: [{x_m: 1, y_m: 2, radius_m: 3, soil: no_such}]\n", "no_such"},
      {"patchs: []\n", "patches"}};
  for (const auto& each : cases)
    EXPECT_THAT([&] { read(each.first); }, ThrowsMessage<InputError>(HasSubstr(each.second))) << each.first;
}

}  // namespace truth_file_test
}  // namespace talus::cli
