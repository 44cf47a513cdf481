#include <talus/common/common.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::terramech {
namespace telemetry_test {

Telemetry small() {
  Telemetry t;
  t.source = "drive.csv";
  t.numbers.push_back({"slip", {0.1, 0.2}});
  t.words.push_back({"run", {"a", "b"}});
  t.lines = {2, 3};
  return t;
}

TEST(Telemetry, FindsColumnsByName) {
  const Telemetry t = small();
  EXPECT_EQ(t.size(), 2U);
  EXPECT_EQ(t.at("slip")[1], 0.2);
  EXPECT_EQ((*t.findWords("run"))[0], "a");
  EXPECT_EQ(t.find("run"), nullptr);
  EXPECT_EQ(t.findWords("slip"), nullptr);
}

TEST(Telemetry, MissingColumnIsNamedInTheError) {
  EXPECT_THAT([] { small().at("load_N"); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("drive.csv: no column load_N")));
}

TEST(Telemetry, ListsKnownColumns) {
  EXPECT_THAT(knownTelemetryColumns(), testing::Contains("sinkage_m"));
  EXPECT_THAT(knownTelemetryColumns(), testing::Not(testing::Contains("run")));
}

}  // namespace telemetry_test
}  // namespace talus::terramech
