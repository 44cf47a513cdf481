#include <cstdlib>
#include <sstream>

#include <nlohmann/json.hpp>

#include "bad_input.hpp"
#include "mpi_ranks.hpp"

namespace talus::cli {
namespace plan_pairs_test {

using testing::HasSubstr;

double rolling(int column, int row) {
  return 0.3 * ((column * 7 + row * 3) % 11) / 11.0;
}

std::string hills(const Folder& folder) {
  return folder.write("hills.asc", asciiGrid(40, 30, rolling));
}

std::string pairs(const Folder& folder) {
  return folder.write("pairs.csv",
                      "start_x_m,start_y_m,goal_x_m,goal_y_m,note\n5,5,35,25,there\n35,25,5,5,back\n"
                      "-5,5,35,25,outside\n5,25,35,5,across\n20,5,20,25,north\n");
}

std::string call(const Folder& folder) {
  return "plan " + hills(folder) + " --pairs " + pairs(folder) +
         " --soil sandy_loam --rover fido --resolution 1 --quiet";
}

TEST(PlanPairs, EachRowEqualsASinglePlan) {
  const Folder folder;
  const Ran many = runTalus({"plan", hills(folder), "--pairs", pairs(folder), "--soil", "sandy_loam",
                             "--rover", "fido", "--resolution", "1", "--json", "--quiet"});
  ASSERT_EQ(many.code, 0) << many.err;
  const auto lines = nlohmann::json::parse(many.out);
  ASSERT_EQ(lines.size(), 5u);
  const Ran one = runTalus({"plan", hills(folder), "--start", "35,25", "--goal", "5,5", "--soil",
                            "sandy_loam", "--rover", "fido", "--resolution", "1", "--json", "--quiet"});
  ASSERT_EQ(one.code, 0) << one.err;
  auto alone = nlohmann::json::parse(one.out), among = lines[1];
  alone.erase("seconds");
  among.erase("pair");
  EXPECT_EQ(among, alone);
  // A pair without a route is reported in its own row.
  EXPECT_EQ(lines[2]["status"], "start_invalid");
  EXPECT_THAT(lines[2]["reason"].get<std::string>(), HasSubstr("start"));
  EXPECT_EQ(lines[3]["status"], "found");
}

TEST(PlanPairs, ResultsAreWrittenAsATable) {
  const Folder folder;
  const std::string out = folder / "routes.csv";
  const Ran ran =
      runTalus({"plan", hills(folder), "--pairs", pairs(folder), "--soil", "sandy_loam", "--rover", "fido",
                "--resolution", "1", "--planner", "hybrid", "-o", out, "--quiet"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::string text = fileContent(out);
  EXPECT_THAT(text, HasSubstr("pair,status,planner,cost,"));
  EXPECT_THAT(text, HasSubstr("\n5,found,hybrid,"));
  EXPECT_THAT(text, HasSubstr("\n3,start_invalid,hybrid,"));
  std::string parts;
  for (const char* part : {"2/2", "1/2"})
    parts += runTalus({"plan", hills(folder), "--pairs", pairs(folder), "--soil", "sandy_loam", "--rover",
                       "fido", "--resolution", "1", "--planner", "hybrid", "--quiet", "--part", part})
                 .out;
  std::stringstream rows(text);
  for (std::string row; std::getline(rows, row);) EXPECT_THAT(parts, HasSubstr(row));
}

TEST(PlanPairs, MpiRanksReproduceTheSingleProcessResult) {
  TALUS_REQUIRE_MPI();
  const Folder folder;
  const auto answer = [&](const std::string& before) {
    const std::string file = folder / "answer.csv";
    EXPECT_EQ(std::system((before + std::string(TALUS_PROGRAM) + " " + call(folder) + " -o " + file).c_str()),
              0);
    return fileContent(file);
  };
  const std::string one = answer("");
  EXPECT_THAT(one, HasSubstr("start_invalid"));
  expectRanksAgree(answer, one);
}

TEST(PlanPairs, ErrorsAreOneLine) {
  const BadFiles files;
  int tables = 0;
  const auto plan = [&](const std::string& table, const std::vector<std::string>& more = {}) {
    return joined({"plan", "good.asc", "--resolution", "1", "--soil", "sandy_loam", "--rover", "fido",
                   "--pairs", files.folder().write("p" + std::to_string(++tables) + ".csv", table)},
                  more);
  };
  const std::string header = "start_x_m,start_y_m,goal_x_m,goal_y_m\n";
  for (const auto& [words, says] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {plan("start_x_m,start_y_m,goal_x_m\n1,1,9\n"), "goal_y_m"},
           {plan(header), "no pair"},
           {plan(header + "1,1,9\n"), ".csv:2"},
           {plan(header + "1,1,9,x\n"), "goal_y_m = 'x'"},
           {plan(header + "1,1,9,inf\n"), "goal_y_m = 'inf'"},
           {plan(header + "1,1,9,1e300\n"), "goal_y_m = 1e+300, must be within 1e+09 of 0"},
           {plan(header + "1,1,9,9\n", {"--start", "5,5"}), "cannot be combined with"},
           {plan(header + "1,1,9,9\n", {"--planner", "PRM"}), "refused"}}) {
    expectRefused(files, {{words, 2, says}});
  }
}

}  // namespace plan_pairs_test
}  // namespace talus::cli
