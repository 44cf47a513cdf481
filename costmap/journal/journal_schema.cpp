#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <sqlite3.h>

#include <talus/common/input_error.hpp>
#include <talus/costmap/journal/journal_rows.hpp>
#include <talus/costmap/journal/journal_schema.hpp>

namespace talus::costmap {
namespace {

// 1 had no z_m, 2 no pose_std_m nor what may raise, 3 no drives, 4 no bounds, 5 no shared errors nor wheels, 6 no share of
// the thrust: a pull that was read at little slip counted as if it had been read at the reference slip. 7 had checksums of
// rows without their drive's id, and could do without
constexpr int kFormat = 8;
constexpr int kFirstWithDrives = 4, kFirstSealed = 8;
constexpr int kApplication = 0x54414c55;  // "TALU"

constexpr const char* kEvidence =
    "CREATE TABLE evidence(id INTEGER PRIMARY KEY AUTOINCREMENT, source TEXT NOT NULL, line INTEGER NOT NULL,"
    " accepted INTEGER NOT NULL, reason TEXT NOT NULL, time_s REAL, x_m REAL, y_m REAL, load_N REAL, slip "
    "REAL,"
    " torque_Nm REAL, sinkage_m REAL, gradient REAL, drawbar_pull_N REAL, pass_index INTEGER,"
    " pull REAL, pull_std REAL, sinkage REAL, sinkage_std REAL, z_m REAL,"
    " pose_std_m REAL NOT NULL DEFAULT 0, pull_may_raise INTEGER NOT NULL DEFAULT 0,"
    " sinkage_may_raise INTEGER NOT NULL DEFAULT 0, drive INTEGER, pull_here REAL, sinkage_here REAL,"
    " pull_shared_std REAL, wheel_radius_m REAL, wheel_width_m REAL, wheel_weight_N REAL, thrust_share REAL)";
constexpr const char* kDrive =
    "CREATE TABLE drive(number INTEGER PRIMARY KEY, id TEXT NOT NULL UNIQUE, checksum INTEGER)";
constexpr const char* kIndex = "CREATE INDEX of_drive ON evidence(drive)";

// All that a journal has, by name.
struct Entry {
  const char* type;
  const char* name;
  const char* sql;
};
constexpr std::array<Entry, 5> kEntries{
    {{"table", "drive", kDrive},
     {"table", "evidence", kEvidence},
     {"index", "of_drive", kIndex},
     {"index", "sqlite_autoindex_drive_1", ""},
     {"table", "sqlite_sequence", "CREATE TABLE sqlite_sequence(name,seq)"}}};

struct Found {
  std::string type, name, sql;
};

std::vector<Found> entriesOf(const JournalDatabase& database) {
  std::vector<Found> found;
  const auto rows = database.prepare("SELECT type, name, sql FROM sqlite_master ORDER BY name");
  while (database.step(rows))
    found.push_back({journalText(rows.get(), 0), journalText(rows.get(), 1), journalText(rows.get(), 2)});
  return found;
}

bool isExact(const std::vector<Found>& found) {
  return std::ranges::equal(found, kEntries, [](const Found& a, const Entry& b) {
    return a.type == b.type && a.name == b.name && a.sql == b.sql;
  });
}

bool has(const std::vector<Found>& found, const char* name) {
  return std::ranges::find(found, name, &Found::name) != found.end();
}

[[noreturn]] void refuseForeign(const JournalDatabase& database, const std::string& what) {
  throw InputError({database.path(), what + ": it was changed, or is no evidence journal",
                    "restore the journal from a copy"});
}

void requireKnown(const JournalDatabase& database, const std::vector<Found>& found) {
  for (const Found& entry : found)
    if (std::ranges::none_of(kEntries, [&](const Entry& known) {
          return entry.type == known.type && entry.name == known.name;
        }))
      refuseForeign(database, "holds a " + entry.type + " that Talus did not make");
}

std::vector<std::string> columnsOf(const JournalDatabase& database, const std::string& table) {
  std::vector<std::string> names;
  const auto rows =
      database.prepare(("SELECT name, hidden FROM pragma_table_xinfo('" + table + "')").c_str());
  while (database.step(rows)) {
    if (sqlite3_column_int(rows.get(), 1) != 0)
      refuseForeign(database, "table " + table + " has a computed column");
    names.push_back(journalText(rows.get(), 0));
  }
  return names;
}

// Puts the rows of a table of an older format into that of the present one, and drops it.
void moveRows(const JournalDatabase& database, const std::string& from, const std::string& to) {
  const std::vector<std::string> known = columnsOf(database, to);
  std::string names;
  for (const std::string& column : columnsOf(database, from)) {
    if (std::ranges::find(known, column) == known.end())
      refuseForeign(database, "table " + to + " has a column that Talus did not make");
    names += (names.empty() ? "" : ", ") + column;
  }
  database.run("INSERT INTO " + to + '(' + names + ") SELECT " + names + " FROM " + from);
  database.run("DROP TABLE " + from);
}

void makeTables(const JournalDatabase& database) {
  for (const char* sql : {kEvidence, kDrive, kIndex}) database.run(sql);
}

void remakeTables(const JournalDatabase& database, const std::vector<Found>& found) {
  database.run("DROP INDEX IF EXISTS of_drive");
  database.run("ALTER TABLE evidence RENAME TO old_evidence");
  if (has(found, "drive")) database.run("ALTER TABLE drive RENAME TO old_drive");
  makeTables(database);
  moveRows(database, "old_evidence", "evidence");
  if (has(found, "drive")) moveRows(database, "old_drive", "drive");
}

// Rows from before there were drives: what one source gave counts as one drive.
void adopt(const JournalDatabase& database) {
  database.run(
      "INSERT INTO drive(id) SELECT 'source ' || source FROM evidence WHERE drive IS NULL GROUP BY source "
      "ORDER BY min(id)");
  database.run(
      "UPDATE evidence SET drive = (SELECT number FROM drive WHERE drive.id = 'source ' || evidence.source) "
      "WHERE drive IS NULL");
}

// Adopted drives had no checksum; all others have, of their rows.
void sealDrives(const JournalDatabase& database) {
  std::vector<DriveEntry> drives;
  const auto rows = database.prepare("SELECT number, id, checksum FROM drive");
  while (database.step(rows)) {
    DriveEntry drive{sqlite3_column_int64(rows.get(), 0), journalText(rows.get(), 1), 0};
    if (!isDriveId(drive.id)) database.refuse("holds a drive whose id is none: the journal was changed");
    if (sqlite3_column_type(rows.get(), 2) != SQLITE_NULL)
      drive.checksum = static_cast<std::uint64_t>(sqlite3_column_int64(rows.get(), 2));
    else if (drive.id.starts_with("source "))
      drive.checksum = rowsChecksum(database, drive.number, 0, kBeforeAllRows);
    else
      database.refuse("drive " + drive.id + " has no checksum: the journal was changed");
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

}  // namespace

void beginJournal(const JournalDatabase& database) {
  const bool marked = database.single("PRAGMA application_id") == kApplication;
  if (!marked && database.single("SELECT count(*) FROM sqlite_master") > 0)
    throw InputError({database.path(), "an SQLite file, but no evidence journal", "name another file"});
  database.run("PRAGMA journal_mode = WAL");
  database.run("PRAGMA synchronous = FULL");
  // The mark comes before the table: a process killed in between leaves a journal, if an empty one.
  if (!marked) database.run("PRAGMA application_id = " + std::to_string(kApplication));
}

void bringUpToDate(const JournalDatabase& database) {
  const std::int64_t format = database.single("PRAGMA user_version");
  if (format > kFormat)
    throw InputError({database.path(),
                      "an evidence journal of format " + std::to_string(format) + ", newer than " +
                          std::to_string(kFormat),
                      "use the program that wrote it"});
  const std::vector<Found> found = entriesOf(database);
  const bool made = format == 0 && found.empty();
  requireKnown(database, found);
  if (!made && !has(found, "evidence")) refuseForeign(database, "holds no table evidence");
  if (!isExact(found)) {
    if (format == kFormat) refuseForeign(database, "its tables are not those of a journal");
    if (made)
      makeTables(database);
    else
      remakeTables(database, found);
  }
  if (format == kFormat) return;
  if (format < kFirstWithDrives) adopt(database);
  if (format < kFirstSealed) sealDrives(database);
  database.run("PRAGMA user_version = " + std::to_string(kFormat));
}

}  // namespace talus::costmap
