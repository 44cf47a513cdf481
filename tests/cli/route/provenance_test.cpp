#include <nlohmann/json.hpp>

#include <talus/cli/route/provenance.hpp>

namespace talus::cli {
namespace provenance_test {

// Property: calls that differ only in program path, outputs and threads have the same text.
TEST(Provenance, CallTextOmitsOutputsAndThreads) {
  const char* const long_call[] = {"/usr/bin/talus", "plan",          "dem.tif",   "--start", "1,2",    "-o",
                                   "r.geojson",      "--html=p.html", "--threads", "4",       "--seed", "7",
                                   "--json",         "--via",         "it's here", nullptr};
  const char* const short_call[] = {"talus",  "plan", "dem.tif", "--start",   "1,2",
                                    "--seed", "7",    "--via",   "it's here", nullptr};
  EXPECT_EQ(callText(long_call), callText(short_call));
  EXPECT_EQ(callText(short_call), "talus plan dem.tif --start 1,2 --seed 7 --via 'it'\\''s here'");
  EXPECT_EQ(callText(nullptr), "");
}

TEST(Provenance, ProvenanceListsTheInputsOfARoute) {
  const auto inputs = nlohmann::ordered_json::parse(
      R"({"files":[{"file":"dem.tif","path":"x/dem.tif","sha256":"00ff"}],"seed":7,"version":"0.1.0","rover":"mer",
          "soils":["sand","clay"],"command":"talus plan dem.tif"})");
  using Facts = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(provenanceOf(inputs), (Facts{{"command", "talus plan dem.tif"},
                                         {"rover", "mer"},
                                         {"soil", "sand, clay"},
                                         {"seed", "7"},
                                         {"version", "0.1.0"},
                                         {"SHA-256", "dem.tif 00ff"}}));
  EXPECT_TRUE(provenanceOf(nlohmann::ordered_json::array()).empty());
  EXPECT_TRUE(provenanceOf(nlohmann::ordered_json()).empty());
}

}  // namespace provenance_test
}  // namespace talus::cli
