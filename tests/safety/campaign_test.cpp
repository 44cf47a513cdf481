// A small campaign for every test run; ./dev safety judges thousands of errands.
#include "campaign.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <unistd.h>

namespace safety {
namespace {

namespace fs = std::filesystem;

// Folder of one test, removed at its end.
class Folder {
 public:
  explicit Folder(const char* name)
      : path_(fs::path(testing::TempDir()) / (name + std::to_string(getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

Places placesIn(const Folder& folder) {
  const char* maps = std::getenv("TALUS_REAL_MAPS");
  return {SAFETY_PROGRAM, SAFETY_LIBRARY, maps ? maps : "", folder.path()};
}

void expectSound(const std::vector<Result>& results) {
  EXPECT_TRUE(std::all_of(results.begin(), results.end(),
                          [](const Result& r) { return r.violations.empty() && r.exit <= 2; }))
      << table(results) << "again: safety_campaign PROGRAM LIBRARY FOLDER 1 NUMBER";
}

// The campaign is split into three tests that can run in parallel.
class SafetyCampaign : public testing::TestWithParam<int> {};

TEST_P(SafetyCampaign, RoutesPassTheIndependentSafetyCheck) {
  const Folder folder("safety_campaign");
  Campaign campaign(placesIn(folder), (folder.path() / "results.csv").string());
  const auto first = static_cast<std::uint64_t>(GetParam()) * 3 * Campaign::routesPerSite();
  campaign.run(first, 24, [](const std::string& text) { ADD_FAILURE() << text; });
  const auto results = campaign.results();
  ASSERT_EQ(results.size(), 24U);
  expectSound(results);
  const auto routes =
      std::count_if(results.begin(), results.end(), [](const Result& r) { return r.exit == 0; });
  EXPECT_GT(routes, 7);  // enough routes to judge; the other errands have no route on these sites
}

INSTANTIATE_TEST_SUITE_P(Parts, SafetyCampaign, testing::Range(1, 4));

TEST(SafetyCampaignFile, InterruptedCampaignResumes) {
  const Folder folder("safety_resume");
  const std::string file = (folder.path() / "results.csv").string();
  const auto fail = [](const std::string& text) { ADD_FAILURE() << text; };
  Campaign(placesIn(folder), file).run(0, 2, fail);
  // The file ends in the middle of a line, as after an interruption.
  std::ofstream(file, std::ios::app) << "\n2;rocks;mer;0;RRT";
  Campaign again(placesIn(folder), file);
  ASSERT_EQ(again.results().size(), 2U);
  EXPECT_EQ(again.missing(0, 3), 1U);
  again.run(0, 3, fail);
  EXPECT_EQ(again.missing(0, 3), 0U);
  const auto results = again.results();
  ASSERT_EQ(results.size(), 3U);
  // Property: a resumed campaign judges the same errands as an uninterrupted campaign.
  Campaign whole(placesIn(folder), (folder.path() / "whole.csv").string());
  whole.run(0, 2, fail);
  const auto straight = whole.results();
  ASSERT_EQ(straight.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const Result &one = straight[k], &other = results[k];
    EXPECT_EQ(one.planner, other.planner);
    EXPECT_EQ(one.kind, other.kind);
    EXPECT_EQ(one.rover, other.rover);
    EXPECT_EQ(one.learned, other.learned);
  }
  // The result of the field planner is compared in full, because it has no time limit.
  ASSERT_EQ(results[0].planner, "field");
  EXPECT_EQ(straight[0].exit, results[0].exit);
  EXPECT_EQ(straight[0].length_m, results[0].length_m);
}

}  // namespace
}  // namespace safety
