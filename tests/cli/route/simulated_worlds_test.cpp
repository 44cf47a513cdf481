#include <cstdlib>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include <talus/cli/app/campaign.hpp>
#include <talus/cli/route/simulated_worlds.hpp>

#include "bad_input.hpp"
#include "mpi_ranks.hpp"

namespace talus::cli {
namespace simulated_worlds_test {

using testing::HasSubstr;

planner::WorldResult numbered(std::size_t b, std::size_t i) {
  planner::WorldResult result;
  result.drive.outcome = i % 2 ? planner::Outcome::Immobilised : planner::Outcome::Reached;
  result.drive.energy_J = (static_cast<double>(i) + 1.0) / 3.0;
  result.drive.replans = static_cast<int>(b);
  result.categories_changed = i;
  return result;
}

// Property: results are bitwise equal and in order after the conversion to text, for any number of workers.
TEST(DriveWorlds, ResultsAreInOrderForAnyWorkerCount) {
  const Campaign campaign;
  for (const std::size_t workers : {1U, 3U}) {
    const SimulatedWorlds driven =
        simulatedWorlds({.beliefs = 2, .worlds = 7, .workers = workers}, numbered, campaign, {});
    ASSERT_EQ(driven.results.size(), 2U);
    EXPECT_TRUE(driven.failures.empty());
    for (std::size_t b = 0; b < 2; ++b) {
      ASSERT_EQ(driven.results[b].size(), 7U);
      for (std::size_t i = 0; i < 7; ++i) {
        const planner::WorldResult expected = numbered(b, i), &got = driven.results[b][i];
        EXPECT_EQ(got.drive.outcome, expected.drive.outcome);
        EXPECT_EQ(got.drive.energy_J, expected.drive.energy_J);
        EXPECT_EQ(got.drive.replans, expected.drive.replans);
        EXPECT_EQ(got.categories_changed, expected.categories_changed);
      }
    }
  }
}

TEST(DriveWorlds, FailedWorldIsReportedAndExcludedUnderEveryBelief) {
  const Campaign campaign;
  const auto world = [](std::size_t b, std::size_t i) {
    if (b == 1 && i == 2) throw std::domain_error("no such ground");
    return numbered(b, i);
  };
  const SimulatedWorlds driven =
      simulatedWorlds({.beliefs = 2, .worlds = 4, .workers = 2}, world, campaign, {});
  ASSERT_EQ(driven.failures.size(), 1U);
  EXPECT_EQ(driven.failures[0].world, 2U);
  EXPECT_EQ(driven.failures[0].reason, "no such ground");
  for (const auto& results : driven.results) {
    ASSERT_EQ(results.size(), 3U);
    EXPECT_EQ(results[2].categories_changed, 3U) << "the same worlds in the same order";
  }
}

TEST(DriveWorlds, MpiRanksReproduceTheSingleProcessResult) {
  TALUS_REQUIRE_MPI();
  const Folder folder;
  const std::string site = folder.write("flat.asc", asciiGrid(30, 20, [](int, int) { return 0.0; }));
  const std::string truth = folder.write(
      "truth.yaml", "random: {spread: 0.1, patches: 4, patch_radius_m: 2, patch_soil: mars_drift}\n");
  const std::string call =
      " drive " + site + " --ignore-crs --resolution 1 --soil sandy_loam --rover sojourner" + " --truth " +
      truth + " --start 4,10 --goal 26,10 --worlds 5 --belief all --json" + " --quiet > ";
  const auto answer = [&](const std::string& before) {
    const std::string file = folder / "answer.json";
    EXPECT_EQ(std::system((before + std::string(TALUS_PROGRAM) + call + file).c_str()), 0);
    return fileContent(file);
  };
  const std::string one = answer("");
  EXPECT_EQ(nlohmann::json::parse(one)["worlds"], 5);
  EXPECT_EQ(nlohmann::json::parse(one)["failed"].size(), 0U);
  expectRanksAgree(answer, one);
}

}  // namespace simulated_worlds_test
}  // namespace talus::cli
