// `talus update` killed at any moment, and two of them at once.
#include <chrono>
#include <csignal>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "bad_input.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace {

// A site in its own folder, its map, and a drive of sixty rows.
class Site {
 public:
  Site() {
    folder.write("flat.asc", asciiGrid(60, 40, [](int, int) { return 0.0; }));
    EXPECT_EQ(runTalus({"costmap", "flat.asc", "--ignore-crs", "--resolution", "1", "--soil", "sandy_loam",
                        "--rover", "sojourner", "-o", "map.ot"},
                       folder.path())
                  .code,
              0);
    std::string text = "time_s,x_m,y_m,slope_rad,load_N,slip\n";
    for (int row = 0; row < 60; ++row)
      text += fmt::format("{},{},20.5,0.02,10,{}\n", row, 5.0 + 0.8 * row, 0.3 + 0.001 * (row % 7));
    folder.write("t.csv", text);
  }

  // Starts an update in the background; the caller waits for it.
  pid_t start(const std::string& journal, const std::string& output) const {
    const pid_t child = ::fork();
    if (child != 0) return child;
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, 1);
    ::dup2(nowhere, 2);
    if (::chdir(folder.path().c_str()) != 0) ::_exit(99);
    ::execl(TALUS_PROGRAM, "talus", "update", "map.ot", "t.csv", "-o", output.c_str(), "--journal",
            journal.c_str(), static_cast<char*>(nullptr));
    ::_exit(98);
  }

  nlohmann::json replay(const std::string& journal, const std::string& output) const {
    const Ran ran = runTalus({"update", "map.ot", "--replay", "--journal", journal, "-o", output, "--json"},
                             folder.path());
    EXPECT_EQ(ran.code, 0) << ran.err;
    return nlohmann::json::parse(ran.out);
  }

  std::string content(const std::string& name) const { return fileContent(folder / name); }

  Folder folder;
};

TEST(UpdateCommand, KilledAtAnyMomentItLeavesWholeFilesAndItsJournal) {
  const Site site;
  ASSERT_EQ(runTalus({"update", "map.ot", "t.csv", "-o", "whole.ot"}, site.folder.path()).code, 0);
  const std::string whole = site.content("whole.ot");
  const auto began = std::chrono::steady_clock::now();
  int status = 0;
  ::waitpid(site.start("timing.db", "timing.ot"), &status, 0);
  ASSERT_EQ(status, 0);
  const auto takes = std::chrono::steady_clock::now() - began;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> moment(0.0, 1.2);
  std::size_t interrupted = 0;
  std::int64_t rows = 0;
  constexpr int kKills = 60;  // 200 went as well, by hand
  for (int kill = 0; kill < kKills; ++kill) {
    const pid_t child = site.start("evidence.db", "out.ot");
    std::this_thread::sleep_for(moment(random) * takes);
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) ++interrupted;
    const std::string out = site.content("out.ot");
    ASSERT_TRUE(out.empty() || out == whole) << "a partial map after kill " << kill;
    std::filesystem::remove(site.folder / "out.ot");
    if (kill % 20 != 19) continue;
    // Every row that a run got to is there, and the map that the journal makes is the same each time.
    const auto report = site.replay("evidence.db", "one.ot");
    EXPECT_GE(report["rows_used"].get<std::int64_t>(), rows);
    rows = report["rows_used"];
    EXPECT_EQ(report["rows_rejected"], 0);
    site.replay("evidence.db", "two.ot");
    ASSERT_EQ(site.content("one.ot"), site.content("two.ot"));
  }
  EXPECT_GT(interrupted, 15U);
  EXPECT_GT(rows, 60);
  // A whole drive behind all those pieces still goes in.
  ASSERT_EQ(
      runTalus({"update", "map.ot", "t.csv", "-o", "last.ot", "--journal", "evidence.db"}, site.folder.path())
          .code,
      0);
  EXPECT_EQ(site.content("last.ot"), whole);
  EXPECT_EQ(site.replay("evidence.db", "all.ot")["rows_used"], rows + 60);
}

// What a killed update left beside its map goes with the next; that of a process that still runs stays.
TEST(UpdateCommand, ClearsWhatAKilledOneLeft) {
  const Site site;
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);  // so that its number is no process's
  const std::string left = "out.ot.tmp" + std::to_string(child),
                    live = "out.ot.tmp" + std::to_string(::getpid());
  for (const std::string& name :
       {left, live, std::string("out.ot.tmpfile"), "other.ot.tmp" + std::to_string(child)})
    site.folder.write(name, "half a map");
  ASSERT_EQ(runTalus({"update", "map.ot", "t.csv", "-o", "out.ot"}, site.folder.path()).code, 0);
  EXPECT_FALSE(std::filesystem::exists(site.folder / left));
  EXPECT_TRUE(std::filesystem::exists(site.folder / live));
  EXPECT_TRUE(std::filesystem::exists(site.folder / "out.ot.tmpfile"));
  EXPECT_TRUE(std::filesystem::exists(site.folder / ("other.ot.tmp" + std::to_string(child))));
}

// Two updates in turn, each a process that reads the file of the one before, and one replay of both.
TEST(UpdateCommand, DrivesInTurnAreTheJournalAtOnce) {
  const Site site;
  std::string text = "time_s,x_m,y_m,slope_rad,load_N,slip\n";
  for (int row = 0; row < 60; ++row)
    text += fmt::format("{},{},22.5,0.02,10,{}\n", 100 + row, 50.0 - 0.7 * row, 0.5 + 0.001 * (row % 7));
  site.folder.write("back.csv", text);
  ASSERT_EQ(
      runTalus({"update", "map.ot", "t.csv", "-o", "first.ot", "--journal", "e.db"}, site.folder.path()).code,
      0);
  ASSERT_EQ(
      runTalus({"update", "first.ot", "back.csv", "-o", "both.ot", "--journal", "e.db"}, site.folder.path())
          .code,
      0);
  EXPECT_EQ(site.replay("e.db", "again.ot")["rows_used"], 120);
  EXPECT_TRUE(site.content("both.ot") == site.content("again.ot"));
}

TEST(UpdateCommand, TwoAtOnceShareAJournal) {
  const Site site;
  const pid_t a = site.start("evidence.db", "a.ot"), b = site.start("evidence.db", "b.ot");
  int first = -1, second = -1;
  ::waitpid(a, &first, 0);
  ::waitpid(b, &second, 0);
  EXPECT_EQ(first, 0);
  EXPECT_EQ(second, 0);
  EXPECT_EQ(site.content("a.ot"), site.content("b.ot"));
  EXPECT_EQ(site.replay("evidence.db", "c.ot")["rows_used"], 120);
}

}  // namespace
}  // namespace talus::cli
