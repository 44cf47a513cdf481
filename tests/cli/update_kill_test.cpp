// `talus update` killed at random times, and concurrent updates.
#include <chrono>
#include <csignal>
#include <cstdlib>
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
namespace update_kill_test {

// A site in its own folder with its map and a drive of 60 rows.
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

// A drive is counted once in map and journal if an update is killed at a random time and repeated. The
// environment variable TALUS_KILLS sets the number of kills (default 40).
TEST(UpdateCommand, DriveIsCountedOnceAfterRetryWhenKilledAtAnyMoment) {
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
  const char* more = std::getenv("TALUS_KILLS");
  const int kills = more != nullptr ? std::atoi(more) : 40;
  for (int kill = 0; kill < kills; ++kill) {
    const pid_t child = site.start("evidence.db", "out.ot");
    std::this_thread::sleep_for(moment(random) * takes);
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    const std::string out = site.content("out.ot");
    ASSERT_TRUE(out.empty() || out == whole) << "a partial map after kill " << kill;
    if (kill % 4 != 3) continue;
    ASSERT_EQ(runTalus({"update", "map.ot", "t.csv", "-o", "retry.ot", "--journal", "evidence.db"},
                       site.folder.path())
                  .code,
              0);
    ASSERT_EQ(site.content("retry.ot"), whole) << kill;
    EXPECT_EQ(site.replay("evidence.db", "again.ot")["rows_used"], 60);
    ASSERT_EQ(site.content("again.ot"), whole) << kill;
    for (const char* name :
         {"evidence.db", "evidence.db-wal", "evidence.db-shm", "out.ot", "retry.ot", "again.ot"})
      std::filesystem::remove(site.folder / name);
  }
}

TEST(UpdateCommand, FailedUpdateLeavesTheJournalUnchanged) {
  const Site site;
  EXPECT_EQ(
      runTalus({"update", "map.ot", "t.csv", "-o", "no/out.ot", "--journal", "e.db"}, site.folder.path())
          .code,
      2);
  site.folder.write("off.csv", "time_s,x_m,y_m,slope_rad,load_N,slip\n1,900,900,0,10,0.3\n");
  EXPECT_EQ(
      runTalus({"update", "map.ot", "off.csv", "-o", "out.ot", "--journal", "e.db"}, site.folder.path()).code,
      2);
  EXPECT_EQ(
      runTalus({"update", "map.ot", "t.csv", "-o", "out.ot", "--journal", "e.db"}, site.folder.path()).code,
      0);
  EXPECT_EQ(site.replay("e.db", "again.ot")["rows_used"], 60);
  EXPECT_EQ(site.content("again.ot"), site.content("out.ot"));
}

// A drive is identified by its content, not by its file name.
TEST(UpdateCommand, RepeatedDriveIsCountedOnceWithAWarning) {
  const Site site;
  site.folder.write("copy.csv", site.content("t.csv"));
  ASSERT_EQ(
      runTalus({"update", "map.ot", "t.csv", "-o", "a.ot", "--journal", "e.db"}, site.folder.path()).code, 0);
  const Ran again =
      runTalus({"update", "a.ot", "copy.csv", "-o", "b.ot", "--journal", "e.db"}, site.folder.path());
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.err,
              testing::HasSubstr("all rows of this drive are in the map already; no row is added"));
  EXPECT_EQ(site.content("a.ot"), site.content("b.ot"));
  EXPECT_EQ(site.replay("e.db", "c.ot")["rows_used"], 60);
}

// Two updates in sequence, each starting from the map of the update before, equal one replay of both drives.
TEST(UpdateCommand, SequentialUpdatesEqualOneReplay) {
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

TEST(UpdateCommand, ConcurrentUpdatesShareAJournal) {
  const Site site;
  const pid_t a = site.start("evidence.db", "a.ot"), b = site.start("evidence.db", "b.ot");
  int first = -1, second = -1;
  ::waitpid(a, &first, 0);
  ::waitpid(b, &second, 0);
  EXPECT_EQ(first, 0);
  EXPECT_EQ(second, 0);
  EXPECT_EQ(site.content("a.ot"), site.content("b.ot"));
  EXPECT_EQ(site.replay("evidence.db", "c.ot")["rows_used"], 60);
  EXPECT_EQ(site.content("a.ot"), site.content("c.ot"));
}

}  // namespace update_kill_test
}  // namespace talus::cli
