#include <cmath>

#include <nlohmann/json.hpp>

#include "bad_input.hpp"

namespace talus::cli {
namespace explain_command_test {

using nlohmann::json;
using testing::HasSubstr;

double ramp(int column, int) {
  return 0.1 * column;
}

std::vector<std::string> explain(const std::vector<std::string>& more) {
  return joined(
      {"explain", "dem.asc", "--resolution", "1", "--soil", "sandy_loam", "--rover", "fido", "--quiet"},
      more);
}

// Closed form: a plane rising eastwards by 0.1: slope atan 0.1 uphill to the east, the same downhill to the
// west, 0 to the north.
TEST(ExplainCommand, CellAndSlopeAlongTheHeadingMatchTheMap) {
  const Folder folder;
  folder.write("dem.asc", asciiGrid(40, 40, ramp));
  const auto slopes = [&folder](const std::string& heading) {
    const Ran ran = runTalus(explain({"--at", "20.5,12.5", "--json", "--heading", heading}), folder.path());
    EXPECT_EQ(ran.code, 0) << ran.err;
    const json why = json::parse(ran.out, nullptr, false);
    EXPECT_EQ(why["column"], 20);
    EXPECT_EQ(why["row"], 12);
    EXPECT_EQ(why["category"].get<std::string>().empty(), false);
    double along = NAN;
    for (const json& cause : why["causes"])
      if (cause["name"].get<std::string>() == "slope_along_rad") along = cause["value"];
    return along;
  };
  EXPECT_NEAR(slopes("0"), std::atan(0.1), 1e-3);
  EXPECT_NEAR(slopes("3.14159265"), -std::atan(0.1), 1e-3);
  EXPECT_NEAR(slopes("1.57079633"), 0.0, 1e-3);
}

// Property: text and JSON output list the same causes.
TEST(ExplainCommand, TextListsTheCausesOfTheJson) {
  const Folder folder;
  folder.write("dem.asc", asciiGrid(40, 40, ramp));
  const json why = json::parse(runTalus(explain({"--at", "20.5,12.5", "--json"}), folder.path()).out);
  const std::string text = runTalus(explain({"--at", "20.5,12.5"}), folder.path()).out;
  EXPECT_GT(why["causes"].size(), 3U);
  for (const json& cause : why["causes"]) EXPECT_THAT(text, HasSubstr(cause["name"].get<std::string>()));
  EXPECT_THAT(text, HasSubstr(why["verdict"].get<std::string>()));
}

}  // namespace explain_command_test
}  // namespace talus::cli
