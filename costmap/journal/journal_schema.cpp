#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <sqlite3.h>

#include <talus/common/input_error.hpp>
#include <talus/costmap/journal/journal_rows.hpp>
#include <talus/costmap/journal/journal_schema.hpp>

namespace talus::costmap {
namespace {

constexpr int kFormat = 10;
constexpr int kFormat010 = 3;             // format of Talus 0.1.0, the only other released format
constexpr int kApplication = 0x54414c55;  // "TALU"

// Columns that also exist in 0.1.0.
const std::string kColumns010 =
    "id INTEGER PRIMARY KEY AUTOINCREMENT, source TEXT NOT NULL, line INTEGER NOT NULL,"
    " accepted INTEGER NOT NULL, reason TEXT NOT NULL, time_s REAL, x_m REAL, y_m REAL, load_N REAL, slip "
    "REAL,"
    " torque_Nm REAL, sinkage_m REAL, gradient REAL, drawbar_pull_N REAL, pass_index INTEGER,"
    " pull REAL, pull_std REAL, sinkage REAL, sinkage_std REAL, z_m REAL,"
    " pose_std_m REAL NOT NULL DEFAULT 0, pull_may_raise INTEGER NOT NULL DEFAULT 0,"
    " sinkage_may_raise INTEGER NOT NULL DEFAULT 0";
constexpr const char* kNames010 =
    "id, source, line, accepted, reason, time_s, x_m, y_m, load_N, slip, torque_Nm, sinkage_m, gradient, "
    "drawbar_pull_N, pass_index, pull, pull_std, sinkage, sinkage_std, z_m, pose_std_m, pull_may_raise, "
    "sinkage_may_raise";

// A table or index: type, name and SQL definition.
struct Entry {
  std::string type, name, sql;
  friend bool operator==(const Entry&, const Entry&) = default;
};
const Entry kSequence{"table", "sqlite_sequence", "CREATE TABLE sqlite_sequence(name,seq)"};

// Returns all entries of a journal, sorted by name.
const std::vector<Entry>& entriesOfJournal() {
  static const std::vector<Entry> entries{
      {"table", "drive",
       "CREATE TABLE drive(number INTEGER PRIMARY KEY, id TEXT NOT NULL UNIQUE, checksum INTEGER)"},
      {"table", "evidence",
       "CREATE TABLE evidence(" + kColumns010 +
           ", drive INTEGER, pull_here REAL, sinkage_here REAL, pull_shared_std REAL, wheel_radius_m REAL, "
           "wheel_width_m REAL, wheel_weight_N REAL, thrust_share REAL, drive_tag INTEGER)"},
      {"index", "of_drive", "CREATE INDEX of_drive ON evidence(drive)"},
      {"index", "sqlite_autoindex_drive_1", ""},
      kSequence};
  return entries;
}

const std::vector<Entry>& entriesOf010() {
  static const std::vector<Entry> entries{{"table", "evidence", "CREATE TABLE evidence(" + kColumns010 + ')'},
                                          kSequence};
  return entries;
}

std::vector<Entry> entriesOf(const JournalDatabase& database) {
  std::vector<Entry> found;
  const auto rows = database.prepare("SELECT type, name, sql FROM sqlite_master ORDER BY name");
  while (database.step(rows))
    found.push_back({journalText(rows.get(), 0), journalText(rows.get(), 1), journalText(rows.get(), 2)});
  return found;
}

void requireExact(const JournalDatabase& database, const std::vector<Entry>& known) {
  const std::vector<Entry> found = entriesOf(database);
  if (found == known) return;
  const auto foreign =
      std::ranges::find_if(found, [&](const Entry& e) { return std::ranges::find(known, e) == known.end(); });
  const std::string what = foreign == found.end()
                               ? "a table is missing in it"
                               : "its " + foreign->type + ' ' + foreign->name + " is not as Talus made it";
  throw InputError({database.path(), what + ": it was changed, or is no evidence journal",
                    "restore the journal from a copy"});
}

void makeTables(const JournalDatabase& database) {
  for (const Entry& entry : entriesOfJournal())
    if (!entry.sql.empty() && entry != kSequence) database.run(entry.sql);
}

// Writes the checksums of all drives.
void sealDrives(const JournalDatabase& database) {
  std::vector<DriveEntry> drives;
  const auto rows = database.prepare("SELECT number, id FROM drive");
  while (database.step(rows)) {
    DriveEntry drive{sqlite3_column_int64(rows.get(), 0), journalText(rows.get(), 1), 0};
    if (!isDriveId(drive.id)) database.refuse("holds a source whose name is none: the journal was changed");
    drive.checksum = rowsChecksum(database, drive.number, 0, kBeforeAllRows);
    drives.push_back(drive);
  }
  const auto seal = database.prepare("UPDATE drive SET checksum = ? WHERE number = ?");
  for (const DriveEntry& drive : drives) {
    sqlite3_bind_int64(seal.get(), 1, static_cast<std::int64_t>(sealed(drive)));
    sqlite3_bind_int64(seal.get(), 2, drive.number);
    database.step(seal);
    sqlite3_reset(seal.get());
  }
}

// Converts a journal of Talus 0.1.0, which has no drives: the rows of a source become one drive.
void takeOver010(const JournalDatabase& database) {
  requireExact(database, entriesOf010());
  database.run("ALTER TABLE evidence RENAME TO evidence_010");
  makeTables(database);
  database.run(
      "INSERT INTO drive(id) SELECT 'source ' || source FROM evidence_010 GROUP BY source ORDER BY min(id)");
  database.run("INSERT INTO evidence(" + std::string(kNames010) + ", drive) SELECT " + kNames010 +
               ", (SELECT number FROM drive WHERE drive.id = 'source ' || source) FROM evidence_010");
  database.run("DROP TABLE evidence_010");
  sealDrives(database);
}

[[noreturn]] void refuseFormat(const JournalDatabase& database, std::int64_t format) {
  const std::string what = "an evidence journal of format " + std::to_string(format);
  if (format > kFormat)
    throw InputError(
        {database.path(), what + ", newer than " + std::to_string(kFormat), "use the program that wrote it"});
  throw InputError({database.path(),
                    what + ", which no release wrote; this program reads " + std::to_string(kFormat),
                    "name another journal and put the telemetry into it again with talus update"});
}

}  // namespace

void beginJournal(const JournalDatabase& database) {
  const bool marked = database.single("PRAGMA application_id") == kApplication;
  if (!marked && database.single("SELECT count(*) FROM sqlite_master") > 0)
    throw InputError({database.path(), "an SQLite file, but no evidence journal", "name another file"});
  database.run("PRAGMA journal_mode = WAL");
  database.run("PRAGMA synchronous = FULL");
  // The mark precedes the tables: a process that is killed in between leaves a valid empty journal.
  if (!marked) database.run("PRAGMA application_id = " + std::to_string(kApplication));
}

void bringUpToDate(const JournalDatabase& database) {
  const std::int64_t format = database.single("PRAGMA user_version");
  if (format == kFormat) return requireExact(database, entriesOfJournal());
  if (format == kFormat010)
    takeOver010(database);
  else if (format == 0 && entriesOf(database).empty())
    makeTables(database);
  else
    refuseFormat(database, format);
  database.run("PRAGMA user_version = " + std::to_string(kFormat));
}

}  // namespace talus::costmap
