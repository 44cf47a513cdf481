#include <sstream>

#include <nlohmann/json.hpp>

#include "bad_input.hpp"

namespace talus::cli {
namespace predict_command_test {

using nlohmann::json;

// The value of a column in the first row of a table.
double value(const std::string& table, const std::string& column) {
  std::istringstream lines(table);
  std::string header, row, name, field;
  std::getline(lines, header);
  std::getline(lines, row);
  std::istringstream names(header), fields(row);
  while (std::getline(names, name, ',') && std::getline(fields, field, ','))
    if (name == column) return std::stod(field);
  ADD_FAILURE() << column << " in " << header;
  return 0.0;
}

// Property: a model that consists of a soil predicts the results of `talus wheel` and ignores measured
// values.
TEST(PredictCommand, PlainSoilPredictsTheWheelEquilibrium) {
  const Folder folder;
  const json wheel = json::parse(runTalus({"--json", "--quiet", "wheel", "--soil", "sandy_loam", "--rover",
                                           "fido", "--load", "80", "--slip", "0.3"})
                                     .out);
  folder.write("model.yaml", "{soil: sandy_loam, model: wong-reece}\n");
  std::string first;
  for (const char* answer : {"1", "999", ""}) {
    folder.write("t.csv",
                 std::string("load_N,slip,torque_Nm,drawbar_pull_N\n80,0.3,") + answer + "," + answer + "\n");
    const Ran ran =
        runTalus({"--json", "predict", "t.csv", "--model", "model.yaml", "--rover", "fido", "-o", "p.csv"},
                 folder.path());
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(json::parse(ran.out)["rows_predicted"], 1);
    const std::string table = fileContent(folder / "p.csv");
    EXPECT_NEAR(value(table, "predicted_drawbar_pull_N"), wheel["drawbar_pull_N"].get<double>(), 1e-5);
    EXPECT_NEAR(value(table, "predicted_torque_Nm"), wheel["torque_Nm"].get<double>(), 1e-5);
    EXPECT_NEAR(value(table, "predicted_sinkage_m"), wheel["sinkage_m"].get<double>(), 1e-7);
  }
}

TEST(PredictCommand, UnpredictableRowsAreListedByLine) {
  const Folder folder;
  folder.write("model.yaml", "{soil: sandy_loam, model: wong-reece}\n");
  folder.write("t.csv", "load_N,slip\n80,0.3\n-5,0.3\n80,0.1\n");
  const Ran ran =
      runTalus({"--json", "predict", "t.csv", "--model", "model.yaml", "--rover", "fido", "-o", "p.csv"},
               folder.path());
  ASSERT_EQ(ran.code, 0) << ran.err;
  const json said = json::parse(ran.out);
  EXPECT_EQ(said["rows_predicted"], 2);
  ASSERT_EQ(said["refused"].size(), 1U);
  EXPECT_EQ(said["refused"][0]["line"], 3);
  EXPECT_THAT(ran.err, testing::HasSubstr("t.csv:3: "));
}

}  // namespace predict_command_test
}  // namespace talus::cli
