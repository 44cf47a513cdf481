#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <talus/common/common.hpp>
#include <talus/costmap/journal/evidence_journal.hpp>

namespace talus::costmap {
namespace evidence_journal_test {

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

// A drive id in the format of DriveId.
std::string idOf(std::int64_t number) {
  std::string digits = std::to_string(number);
  return digits.insert(0, 16 - digits.size(), '0');
}

const std::string kIdA = "000000000000000a", kIdB = "000000000000000b", kIdAb = "00000000000000ab",
                  kIdOther = "0123456789abcdef";

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

TEST_F(EvidenceJournalTest, RowsRoundTripExactly) {
  EvidenceJournal journal(path());
  journal.append(kIdA, {row(7)});
  ASSERT_EQ(journal.rows(kIdA).size(), 1U);
  const JournalRow back = journal.rows(kIdA)[0];
  EXPECT_EQ(back.line, 7);
  EXPECT_EQ(back.reading.place.x_m, 1.0 / 3.0);
  EXPECT_TRUE(std::isnan(back.reading.torque_Nm));
  EXPECT_TRUE(std::isinf(back.observation.sinkage.std));
  EXPECT_EQ(journal.size(), 1);
}

void change(const std::string& path, const char* sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
  sqlite3_close(database);
}

TEST_F(EvidenceJournalTest, UnknownFormatsAreRejectedWithOneLine) {
  for (const int format : {1, 3, 8, 10}) {
    std::filesystem::remove(path());
    { EvidenceJournal(path()).append(kIdA, {row(7)}); }
    change(path(), ("PRAGMA user_version = " + std::to_string(format)).c_str());
    try {
      const EvidenceJournal journal(path());
      ADD_FAILURE() << format;
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(),
                path() + ": an evidence journal of format " + std::to_string(format) +
                    "; this program reads 11; name another journal and put the telemetry into it again with "
                    "talus update");
    }
  }
}

TEST_F(EvidenceJournalTest, DriveIsAppendedOnce) {
  EvidenceJournal journal(path());
  journal.append(kIdA, {row(1), row(2)});
  journal.append(kIdA, {row(1), row(2)});
  EXPECT_EQ(journal.size(), 2);
  EXPECT_THAT(journal.drives(), testing::ElementsAre(kIdA));
}

TEST_F(EvidenceJournalTest, ContinuedDriveReplacesItsEarlierPart) {
  EvidenceJournal journal(path());
  journal.append(kIdA, {row(1)});
  journal.append(kIdOther, {row(9)});
  journal.append(kIdAb, {row(2), row(3)}, kIdA);
  EXPECT_THAT(journal.drives(), testing::ElementsAre(kIdAb, kIdOther));
  ASSERT_EQ(journal.rows(kIdAb).size(), 3U);
  EXPECT_EQ(journal.rows(kIdAb)[2].line, 3);
}

TEST_F(EvidenceJournalTest, UncommittedRowsAreDiscarded) {
  EvidenceJournal journal(path());
  {
    const EvidenceJournal::Transaction transaction(journal);
    journal.append(kIdA, {row(1)});
    EXPECT_EQ(journal.size(), 1);
  }
  EXPECT_EQ(journal.size(), 0);
  {
    EvidenceJournal::Transaction transaction(journal);
    journal.append(kIdA, {row(1)});
    transaction.commit();
  }
  EXPECT_EQ(EvidenceJournal(path()).size(), 1);
}

// Property: a row modified outside Talus is never replayed, for any column, with a valid or an invalid
// value.
TEST_F(EvidenceJournalTest, ModifiedRowsAreRejected) {
  for (const char* sql :
       {"UPDATE evidence SET pull = 9e999", "UPDATE evidence SET pull = NULL",
        "UPDATE evidence SET pull = 0.11", "UPDATE evidence SET sinkage_std = 0",
        "UPDATE evidence SET line = 8", "UPDATE evidence SET torque_Nm = 1",
        "UPDATE evidence SET reason = 'x'", "UPDATE evidence SET accepted = 0", "DELETE FROM evidence",
        "INSERT INTO evidence SELECT 99, source, line, accepted, reason, time_s, x_m, y_m, load_N, slip, "
        "torque_Nm,"
        " sinkage_m, gradient, drawbar_pull_N, pass_index, pull, pull_std, sinkage, sinkage_std, z_m, "
        "pose_std_m,"
        " trust, drive, pull_here, sinkage_here, pull_shared_std, wheel_radius_m,"
        " wheel_width_m, wheel_weight_N, thrust_share, drive_tag FROM evidence"}) {
    std::filesystem::remove(path());
    { EvidenceJournal(path()).append(kIdA, {row(7)}); }
    change(path(), sql);
    const EvidenceJournal journal(path());
    EXPECT_THROW(static_cast<void>(journal.rows(kIdA)), InputError) << sql;
  }
}

// Property: the entry of a drive is valid only with the rows of the drive. (Without this check, a replay with
// a changed id used no row and had exit code 0.)
TEST_F(EvidenceJournalTest, ModifiedDriveEntriesAreRejected) {
  for (const char* sql :
       {"UPDATE drive SET id = zeroblob(1000000) WHERE number = 1",
        "UPDATE drive SET id = CAST(id AS BLOB) WHERE number = 1",
        "UPDATE drive SET id = 'fedcba9876543210' WHERE number = 1",
        "UPDATE drive SET id = 'source x' WHERE number = 1", "UPDATE drive SET id = '' WHERE number = 1",
        "UPDATE drive SET checksum = NULL WHERE number = 1",
        "UPDATE drive SET checksum = 'x' WHERE number = 1", "UPDATE drive SET checksum = 0 WHERE number = 1",
        "UPDATE drive SET number = 3 WHERE number = 1",
        "UPDATE drive SET number = 9 WHERE number = 1; UPDATE drive SET number = 1 WHERE number = 2;"
        "UPDATE drive SET number = 2 WHERE number = 9",
        "UPDATE evidence SET drive = NULL WHERE drive = 1", "UPDATE evidence SET drive = 2 WHERE drive = 1",
        "DELETE FROM evidence WHERE drive = 1; DELETE FROM drive WHERE number = 1",
        "UPDATE evidence SET id = -id", "INSERT INTO drive VALUES(3, '0123', 1)"}) {
    std::filesystem::remove(path());
    {
      EvidenceJournal journal(path());
      journal.append(kIdA, {row(7), row(8)});
      journal.append(kIdB, {row(9), row(10)});
    }
    change(path(), sql);
    const auto readAll = [&] {
      const EvidenceJournal journal(path());
      for (const std::string& drive : journal.drives()) static_cast<void>(journal.rows(drive));
    };
    EXPECT_THROW(readAll(), InputError) << sql;
  }
}

// A trigger that deletes rows, or a view in place of a table, would lose rows without an error.
TEST_F(EvidenceJournalTest, ForeignSchemaObjectsAreRejected) {
  for (const char* format : {"", "; PRAGMA user_version = 3", "; PRAGMA user_version = 0"})
    for (const char* sql :
         {"CREATE TRIGGER t AFTER INSERT ON evidence BEGIN DELETE FROM evidence; END",
          "CREATE TRIGGER t BEFORE INSERT ON drive BEGIN SELECT raise(IGNORE); END",
          "ALTER TABLE evidence RENAME TO e; CREATE VIEW evidence AS SELECT * FROM e WHERE id % 2",
          "ALTER TABLE drive RENAME TO d; CREATE VIEW drive AS WITH RECURSIVE r(n) AS "
          "(SELECT 1 UNION ALL SELECT n + 1 FROM r) SELECT d.* FROM r, d",
          "ALTER TABLE evidence ADD COLUMN more TEXT", "ALTER TABLE drive ADD COLUMN more TEXT",
          "ALTER TABLE evidence ADD COLUMN more AS (slip * 2)", "CREATE TABLE more(a)",
          "CREATE UNIQUE INDEX more ON evidence(load_N)", "DROP TABLE evidence",
          "DROP TABLE evidence; DROP TABLE drive"}) {
      std::filesystem::remove(path());
      { EvidenceJournal(path()).append(kIdA, {row(7)}); }
      change(path(), (sql + std::string(format)).c_str());
      EXPECT_THROW(EvidenceJournal{path()}, InputError) << sql << format;
    }
}

// SQLite interprets these names as databases without a file, whose rows are lost when the process ends.
TEST_F(EvidenceJournalTest, InMemoryAndUriNamesAreRejected) {
  for (const char* name : {"", ":memory:", "file:zz.db?mode=memory", "file:zz.db", "folder/"})
    EXPECT_THROW(EvidenceJournal{name}, InputError) << name;
  EXPECT_THROW(EvidenceJournal(path()).append("a", {row(1)}), std::invalid_argument);
}

// Property: rows of a drive that is not listed are reported as an error.
TEST_F(EvidenceJournalTest, RowsOfAnUnlistedDriveAreRejected) {
  { EvidenceJournal(path()).append(kIdA, {row(7)}); }
  EXPECT_EQ(EvidenceJournal(path()).drives().size(), 1U);
  change(path(), "DELETE FROM drive");
  EXPECT_THROW(static_cast<void>(EvidenceJournal(path()).drives()), InputError);
}

TEST_F(EvidenceJournalTest, BoundsRoundTripExactly) {
  JournalRow bounded = row(3);
  bounded.observation.here = {-0.1 / 3.0, 2.0 / 3.0};
  JournalRow alone = bounded;
  alone.observation.pull = alone.observation.sinkage = {std::nan(""), std::nan("")};
  EvidenceJournal journal(path());
  journal.append(kIdA, {row(2), bounded, alone});
  const auto back = journal.rows(kIdA);
  ASSERT_EQ(back.size(), 3U);
  EXPECT_FALSE(back[0].observation.here.any());
  EXPECT_EQ(back[1].observation.here.most_pull, -0.1 / 3.0);
  EXPECT_EQ(back[1].observation.here.least_sinkage, 2.0 / 3.0);
  EXPECT_FALSE(back[2].observation.estimates());
  EXPECT_EQ(back[2].observation.here.most_pull, -0.1 / 3.0);
}

// SQLite's message quotes the damaged schema; the error line must contain printable characters only.
TEST_F(EvidenceJournalTest, DamagedSchemaErrorIsOnePrintableLine) {
  { EvidenceJournal(path()).append(kIdA, {row(1)}); }
  const auto read = [](const std::string& name) {
    std::ifstream file(name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string whole = read(path());
  int quoted = 0;
  for (std::size_t at = whole.find("CREATE TABLE"); at != std::string::npos;
       at = whole.find("CREATE TABLE", at + 1))
    for (const std::size_t within : {0U, 3U, 7U, 13U, 16U, 30U}) {
      std::string damaged = whole;
      damaged[at + within] = '\xEF';
      std::ofstream(path("damaged.db"), std::ios::binary) << damaged;
      try {
        EvidenceJournal journal(path("damaged.db"));
        ADD_FAILURE() << "accepted with byte " << within;
      } catch (const InputError& error) {
        const std::string line = error.what();
        quoted += line.find('?') != std::string::npos ? 1 : 0;
        for (const char c : line) EXPECT_TRUE(c >= ' ' && c <= '~') << line;
      }
    }
  EXPECT_GT(quoted, 0);
}

TEST_F(EvidenceJournalTest, FilesThatAreNoJournalAreRejected) {
  std::ofstream(path("text.db")) << std::string(5000, 'x');
  EXPECT_THROW(EvidenceJournal{path("text.db")}, InputError);
  EXPECT_THROW(EvidenceJournal{"/nonexistent/evidence.db"}, InputError);
  // SQLite would treat the file of 1 byte as an empty database.
  for (const std::size_t size : {1U, 15U, 100U, 5000U}) {
    { EvidenceJournal(path("cut.db")).append(kIdA, {row(1), row(2)}); }
    std::filesystem::resize_file(path("cut.db"), size);
    EXPECT_THROW(EvidenceJournal(path("cut.db")).rows(kIdA), InputError) << size;
    std::filesystem::remove(path("cut.db"));
  }
}

// Writes rows and reports the number of rows after each, until the process is killed.
[[noreturn]] void writeForever(const std::string& path, int out) {
  EvidenceJournal journal(path);
  for (std::int64_t line = 1;; ++line) {
    journal.append(idOf(line), {row(line)});
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

TEST_F(EvidenceJournalTest, KilledWriterLosesAtMostOneRow) {
  // 200 kills at varied times, the earliest before the first row.
  for (unsigned kill = 0; kill < 200; ++kill) {
    const std::string file = path(std::to_string(kill).append(".db").c_str());
    const std::int64_t told = killedAfter(file, 500 + kill * 7919 % 12000);
    const EvidenceJournal journal(file);
    std::int64_t expected = 1;
    for (const std::string& drive : journal.drives())
      for (const JournalRow& back : journal.rows(drive)) EXPECT_EQ(back.line, expected++);
    ASSERT_GE(journal.size(), told) << kill;
    ASSERT_LE(journal.size(), told + 1) << kill;
  }
}

TEST_F(EvidenceJournalTest, ConcurrentWritersKeepTheJournalIntact) {
  { const EvidenceJournal made(path()); }
  std::vector<pid_t> children;
  for (int writer = 0; writer < 2; ++writer) {
    const pid_t child = ::fork();
    if (child == 0) {
      EvidenceJournal journal(path());
      for (std::int64_t line = 0; line < 100; ++line) journal.append(idOf(1000 * writer + line), {row(line)});
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

}  // namespace evidence_journal_test
}  // namespace talus::costmap
