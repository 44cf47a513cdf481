#include <cstdlib>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "busy_campaign.hpp"
#include "mpi_ranks.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace bench_command_test {

using testing::HasSubstr;

// A room with an obstacle, in the MovingAI map format.
std::string room(const Folder& folder) {
  folder.write(
      "room.map",
      "type octile\nheight 6\nwidth 8\nmap\n........\n..@@@@..\n..@@@@..\n..@@@@..\n........\n........\n");
  return folder.write("room.scen",
                      "version 1\n0\troom.map\t8\t6\t0\t2\t7\t2\t9\n0\troom.map\t8\t6\t1\t1\t6\t4\t7.5\n"
                      "0\troom.map\t8\t6\t0\t0\t7\t5\t10\n");
}

// Results that must not depend on the clock or on the number of processes.
nlohmann::json lasting(const std::string& text) {
  auto lines = nlohmann::json::parse(text);
  for (auto& line : lines) {
    line.erase("median_seconds");
    line.erase("worst_megabytes");
  }
  return lines;
}

TEST(BenchCommand, ComparisonWritesLogsTableAndPage) {
  const Folder folder;
  const Ran ran = runTalus({"bench", room(folder), "--planners", "field,BIT*:cold", "--runs", "2", "--time",
                            "0.2", "-o", folder / "out", "--json"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0]["planner"], "field");
  EXPECT_EQ(json[0]["runs"], 6);
  EXPECT_EQ(json[0]["found"], 6);
  EXPECT_EQ(json[0]["breached"], 0);
  EXPECT_EQ(json[1]["planner"], "BITstar:cold");
  EXPECT_THAT(fileContent(folder / "out/room_1.log"),
              testing::AllOf(HasSubstr("OMPL version"), HasSubstr("Starting at 20")));
  EXPECT_THAT(fileContent(folder / "out/index.html"), HasSubstr("or to the best of all runs"));
  EXPECT_THAT(fileContent(folder / "out/table.txt"), HasSubstr("field"));
}

// Property: parts in any order and of any division give the comparison of the whole; a part of another suite is
// refused and replaces nothing.
TEST(BenchCommand, PartsGiveTheComparisonOfTheWhole) {
  const Folder folder;
  const std::string scen = room(folder);
  const auto bench = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"bench", scen, "--planners", "field", "--runs", "2", "--json", "-o"};
    words.insert(words.end(), more.begin(), more.end());
    return runTalus(words);
  };
  const std::string parts = folder / "parts";
  EXPECT_THAT(bench({parts, "--part", "3/3"}).out, HasSubstr("2 of 6 runs"));
  EXPECT_THAT(bench({parts, "--part", "1/3"}).out, HasSubstr("4 of 6 runs"));
  EXPECT_EQ(lasting(bench({parts, "--part", "2/3"}).out), lasting(bench({folder / "whole"}).out));
  EXPECT_THAT(bench({parts, "--part", "1/3", "--seed", "9"}).err, HasSubstr("is not of these jobs"));
  EXPECT_EQ(lasting(bench({parts, "--part", "1/2"}).out), lasting(bench({folder / "whole"}).out));
  const std::string file = folder / "parts/part_3_of_3.csv", rows = fileContent(file);
  folder.write("parts/part_3_of_3.csv", rows.substr(0, rows.size() - 9));
  EXPECT_THAT(bench({parts, "--part", "1/3"}).err, HasSubstr("part_3_of_3.csv:3: is not of these jobs"));
  EXPECT_EQ(bench({parts, "--part", "4/3"}).code, 2);
}

TEST(BenchCommand, GeneratedSiteIsAccepted) {
  const Folder folder;
  const Ran ran = runTalus({"bench", "--planners", "field", "--runs", "1", "--pairs", "1", "--side", "64",
                            "-o", folder / "out", "--json"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json[0]["found"], json[0]["runs"]);
  EXPECT_EQ(json[0]["breached"], 0);
}

TEST(BenchCommand, SeveralSuitesAreRunAndDrivenOverTrueSlip) {
  const Folder folder;
  const Ran ran = runTalus({"bench", "slip", "grids", room(folder), "--planners", "field", "--runs", "1",
                            "--pairs", "2", "-o", folder / "out", "--json"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto line = nlohmann::json::parse(ran.out)[0];
  EXPECT_EQ(line["runs"],
            2 * 2 + 2 * 2 + 2);  // slip worlds x beliefs + two pairs each of blocks and rooms + room.scen
  EXPECT_EQ(line["breached"], 0);
  ASSERT_EQ(line["drives"].size(), 2u);
  EXPECT_EQ(line["drives"][0]["belief"], "slip mean");
  EXPECT_EQ(line["drives"][1]["runs"], 2);
  EXPECT_LE(line["drives"][1]["reached"].get<int>(), 2);
  EXPECT_THAT(fileContent(folder / "out/table.txt"), HasSubstr("slip tail"));
  EXPECT_THAT(fileContent(folder / "out/index.html"), HasSubstr("Simulated drives over the true slip"));
}

// Measured by others: the reader of OMPL (package ompl-demos of Debian) builds its database from the logs.
TEST(BenchCommand, OmplReadsTheLogs) {
  if (std::system("command -v ompl_benchmark_statistics > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "ompl_benchmark_statistics (package ompl-demos) is not installed";
  const Folder folder;
  ASSERT_EQ(runTalus({"bench", room(folder), "--planners", "field,FMT", "--runs", "2", "--time", "0.2", "-o",
                      folder / "out"})
                .code,
            0);
  const std::string call =
      "cd " + (folder / "out") + " && ompl_benchmark_statistics -d a.db *.log > said.txt 2>&1";
  EXPECT_EQ(std::system(call.c_str()), 0) << fileContent(folder / "out/said.txt");
  EXPECT_THAT(fileContent(folder / "out/said.txt"), HasSubstr("Parsing data for FMT"));
  EXPECT_THAT(fileContent(folder / "out/a.db"), HasSubstr("room_1"));
}

TEST(BenchCommand, MpiRanksReproduceTheSingleProcessResult) {
  TALUS_REQUIRE_MPI();
  const Folder folder;
  const std::string call = std::string(TALUS_PROGRAM) + " bench " + room(folder) +
                           " --planners field --runs 2 --json -o " + folder / "out";
  const auto answer = [&](const std::string& before) {
    const std::string file = folder / "answer.json";
    EXPECT_EQ(std::system((before + call + " > " + file).c_str()), 0);
    return lasting(fileContent(file));
  };
  const auto one = answer("");
  expectRanksAgree(answer, one);
}

// A campaign of six short runs and six runs of up to 600 s, which is interrupted during the long runs.
std::string longCampaign(const Folder& folder) {
  return std::string(TALUS_PROGRAM) + " bench " + room(folder) +
         " --planners 'field,BIT*' --runs 2 --time 600 --json -o " + folder / "out" + " > " +
         folder / "out.txt" + " 2> " + folder / "err.txt";
}

void expectTheFastRunsKept(const Folder& folder) {
  const std::string table = fileContent(folder / "out/table.txt");
  EXPECT_THAT(table, HasSubstr("cancelled: 6 of 12 runs")) << table;
  EXPECT_THAT(fileContent(folder / "out/index.html"), HasSubstr("cancelled: 6 of 12 runs"));
  EXPECT_THAT(fileContent(folder / "out/room_3.log"), HasSubstr("cancelled: 2 of 4 runs"));
  for (const auto& entry : std::filesystem::directory_iterator(folder / "out"))
    EXPECT_FALSE(entry.path().filename().string().starts_with('.')) << entry.path();
}

TEST(BenchCommand, CancelledCampaignKeepsCompletedRuns) {
  const Folder folder;
  EXPECT_EQ(interruptedWhenBusy("exec " + longCampaign(folder), 1), 130);
  EXPECT_EQ(fileContent(folder / "out.txt"), "");  // stdout contains a complete table or nothing
  EXPECT_THAT(fileContent(folder / "err.txt"), HasSubstr("cancelled after 6 of 12 runs"));
  expectTheFastRunsKept(folder);
}

TEST(BenchCommand, CancelledMpiCampaignKeepsCompletedRuns) {
  TALUS_REQUIRE_MPI();
  const Folder folder;
  EXPECT_NE(interruptedWhenBusy("exec env " + mpirun(2) + longCampaign(folder), 2), 0);
  expectTheFastRunsKept(folder);
}

}  // namespace bench_command_test
}  // namespace talus::cli
