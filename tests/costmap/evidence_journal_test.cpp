#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <talus/costmap/evidence_journal.hpp>
#include <talus/talus.hpp>

namespace talus::costmap {
namespace {

class EvidenceJournalTest : public ::testing::Test {
 protected:
  EvidenceJournalTest()
      : folder_(std::filesystem::path(::testing::TempDir()) / ("journal" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~EvidenceJournalTest() override { std::filesystem::remove_all(folder_); }

  std::string path(const char* name = "evidence.db") const { return (folder_ / name).string(); }

 private:
  std::filesystem::path folder_;
};

JournalRow row(std::int64_t line) {
  return {.source = "drive.csv",
          .line = line,
          .accepted = true,
          .reason = "",
          .reading = {.time_s = 0.1 * static_cast<double>(line),
                      .place = {1.0 / 3.0, 2.0},
                      .load_N = 40.0,
                      .slip = 0.2,
                      .torque_Nm = std::numeric_limits<double>::quiet_NaN()},
          .observation = {
              .place = {}, .pull = {0.1, 0.05}, .sinkage = {0.2, std::numeric_limits<double>::infinity()}}};
}

TEST_F(EvidenceJournalTest, GivesRowsBackToTheBit) {
  EvidenceJournal journal(path());
  journal.append(row(7));
  journal.forEach([](const JournalRow& back) {
    EXPECT_EQ(back.line, 7);
    EXPECT_EQ(back.reading.place.x_m, 1.0 / 3.0);
    EXPECT_TRUE(std::isnan(back.reading.torque_Nm));
    EXPECT_TRUE(std::isinf(back.observation.sinkage.std));
  });
  EXPECT_EQ(journal.size(), 1);
}

void change(const std::string& path, const char* sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
  sqlite3_close(database);
}

// Rows of a journal without heights are on top: theirs is not known.
TEST_F(EvidenceJournalTest, TakesOverJournalsWithoutHeights) {
  { EvidenceJournal(path()).append(row(7)); }
  change(path(), "ALTER TABLE evidence DROP COLUMN z_m; PRAGMA user_version = 1");
  EvidenceJournal journal(path());
  JournalRow high = row(8);
  high.reading.z_m = -2500.0 / 3.0;
  journal.append(high);
  std::vector<double> heights;
  journal.forEach([&](const JournalRow& back) {
    heights.push_back(back.reading.z_m);
    EXPECT_TRUE(std::isnan(back.observation.z_m) || back.observation.z_m == back.reading.z_m);
  });
  ASSERT_EQ(heights.size(), 2U);
  EXPECT_TRUE(std::isnan(heights[0]));
  EXPECT_EQ(heights[1], -2500.0 / 3.0);
}

TEST_F(EvidenceJournalTest, RefusesAFormatOfTheFuture) {
  { EvidenceJournal(path()).append(row(7)); }
  change(path(), "PRAGMA user_version = 4");
  EXPECT_THROW(EvidenceJournal{path()}, InputError);
}

TEST_F(EvidenceJournalTest, RefusesWhatIsNoJournal) {
  std::ofstream(path("text.db")) << std::string(5000, 'x');
  EXPECT_THROW(EvidenceJournal{path("text.db")}, InputError);
  EXPECT_THROW(EvidenceJournal{"/nonexistent/evidence.db"}, InputError);
}

// Writes rows and says after each how many are in, until it is killed.
[[noreturn]] void writeForever(const std::string& path, int out) {
  EvidenceJournal journal(path);
  for (std::int64_t line = 1;; ++line) {
    journal.append(row(line));
    if (::write(out, &line, sizeof line) < 0) ::_exit(1);
  }
}

std::int64_t killedAfter(const std::string& path, useconds_t microseconds) {
  int ends[2];
  if (::pipe(ends) != 0) return -1;
  const pid_t child = ::fork();
  if (child == 0) writeForever(path, ends[1]);
  ::close(ends[1]);
  ::usleep(microseconds);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  std::int64_t told = 0, line = 0;
  while (::read(ends[0], &line, sizeof line) == sizeof line) told = line;
  ::close(ends[0]);
  return told;
}

TEST_F(EvidenceJournalTest, AKilledWriterLosesAtMostTheRowBeingWritten) {
  // 200 kills at scattered moments, from before the first row on.
  for (unsigned kill = 0; kill < 200; ++kill) {
    const std::string file = path(std::to_string(kill).append(".db").c_str());
    const std::int64_t told = killedAfter(file, 500 + kill * 7919 % 12000);
    const EvidenceJournal journal(file);
    std::int64_t expected = 1;
    journal.forEach([&](const JournalRow& back) { EXPECT_EQ(back.line, expected++); });
    ASSERT_GE(journal.size(), told) << kill;
    ASSERT_LE(journal.size(), told + 1) << kill;
  }
}

TEST_F(EvidenceJournalTest, TwoWritersDoNotCorruptIt) {
  { const EvidenceJournal made(path()); }
  std::vector<pid_t> children;
  for (int writer = 0; writer < 2; ++writer) {
    const pid_t child = ::fork();
    if (child == 0) {
      EvidenceJournal journal(path());
      for (std::int64_t line = 0; line < 100; ++line) journal.append(row(line));
      ::_exit(0);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(EvidenceJournal(path()).size(), 200);
}

}  // namespace
}  // namespace talus::costmap
