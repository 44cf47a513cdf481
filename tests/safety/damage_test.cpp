// A small number of damaged files for every test run; ./dev damage tries thousands.
#include "damage.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include <unistd.h>

#include "damaged_site.hpp"

namespace safety {
namespace {

namespace fs = std::filesystem;

class DamageFolder {
 public:
  DamageFolder() : path_(fs::path(testing::TempDir()) / ("safety_damage" + std::to_string(getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~DamageFolder() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }
  Places places() const {
    const char* maps = std::getenv("TALUS_REAL_MAPS");
    return {SAFETY_PROGRAM, SAFETY_LIBRARY, maps ? maps : "", path_};
  }

 private:
  fs::path path_;
};

// The campaign is split into two tests that can run in parallel.
class DamagedFiles : public testing::TestWithParam<std::uint64_t> {};

TEST_P(DamagedFiles, RoutesOnDamagedFilesAreNoLessSafe) {
  const DamageFolder folder;
  DamageCampaign campaign(folder.places(), (folder.path() / "damage.csv").string());
  const std::uint64_t first = GetParam() * DamageCampaign::kPerSite;
  campaign.run(first, 50, [](const std::string& text) { ADD_FAILURE() << text; });
  const auto results = campaign.results();
  ASSERT_EQ(results.size(), 50U);
  EXPECT_TRUE(std::all_of(
      results.begin(), results.end(),
      [](const DamageResult& r) { return r.causes.empty() && r.exit <= 2 && r.complaint.empty(); }))
      << table(results) << "again: damage_campaign PROGRAM LIBRARY FOLDER 1 NUMBER";
  EXPECT_GT(std::count_if(results.begin(), results.end(), [](const DamageResult& r) { return r.exit == 2; }),
            8);
}

INSTANTIATE_TEST_SUITE_P(Parts, DamagedFiles, testing::Values(0, 1));

TEST(Damage, DamageIsReproducibleAndCoversEveryKind) {
  std::string bytes;
  for (int k = 0; k < 20000; ++k) bytes += static_cast<char>(1 + k % 250);
  std::set<std::string> kinds;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    std::mt19937_64 one(seed), other(seed);
    const auto [made, what] = damaged(bytes, one);
    EXPECT_EQ(made, damaged(bytes, other).first);
    EXPECT_LE(made.size(), bytes.size());
    kinds.insert(what.substr(0, what.find(' ')));
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"removed", "cut", "zeroed", "one", "random", "moved"}));
}

// Property: the checker reports a route that crosses an obstacle of the undamaged site.
TEST(Damage, UnsafeRouteIsDetected) {
  const DamageFolder folder;
  DamagedSite site(folder.places(), 1);
  // The line crosses the whole site, including obstacles and steep ground.
  const Raster dem = readRaster(site.folder() / "dem.asc");
  std::string line;
  for (int k = 0; k <= 40; ++k) {
    const double t = 0.02 + 0.96 * k / 40;
    line += (k ? ",[" : "[") + std::to_string(dem.west_m + t * dem.width * dem.cell_m) + "," +
            std::to_string(dem.south_m + t * dem.height * dem.cell_m) + "]";
  }
  const DamageResult refused =
      site.tried("route.geojson",
                 R"({"type":"FeatureCollection","crs":"local","features":[{"type":"Feature","properties":{},)"
                 R"("geometry":{"type":"LineString","coordinates":[)" +
                     line + "]}}]}",
                 0);
  EXPECT_NE(refused.exit, 0) << refused.complaint;
}

}  // namespace
}  // namespace safety
