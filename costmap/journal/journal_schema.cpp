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
constexpr int kApplication = 0x54414c55;  // "TALU"

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
       "CREATE TABLE evidence(id INTEGER PRIMARY KEY AUTOINCREMENT, source TEXT NOT NULL, line INTEGER NOT "
       "NULL,"
       " accepted INTEGER NOT NULL, reason TEXT NOT NULL, time_s REAL, x_m REAL, y_m REAL, load_N REAL, slip "
       "REAL,"
       " torque_Nm REAL, sinkage_m REAL, gradient REAL, drawbar_pull_N REAL, pass_index INTEGER,"
       " pull REAL, pull_std REAL, sinkage REAL, sinkage_std REAL, z_m REAL,"
       " pose_std_m REAL NOT NULL DEFAULT 0, pull_may_raise INTEGER NOT NULL DEFAULT 0,"
       " sinkage_may_raise INTEGER NOT NULL DEFAULT 0, drive INTEGER, pull_here REAL, sinkage_here REAL, "
       "pull_shared_std REAL, wheel_radius_m REAL, wheel_width_m REAL, wheel_weight_N REAL, thrust_share "
       "REAL, "
       "drive_tag INTEGER)"},
      {"index", "of_drive", "CREATE INDEX of_drive ON evidence(drive)"},
      {"index", "sqlite_autoindex_drive_1", ""},
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

void requireExact(const JournalDatabase& database) {
  const std::vector<Entry>&known = entriesOfJournal(), found = entriesOf(database);
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

[[noreturn]] void refuseFormat(const JournalDatabase& database, std::int64_t format) {
  throw InputError({database.path(),
                    "an evidence journal of format " + std::to_string(format) + "; this program reads " +
                        std::to_string(kFormat),
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
  if (format == kFormat) return requireExact(database);
  if (format != 0 || !entriesOf(database).empty()) refuseFormat(database, format);
  makeTables(database);
  database.run("PRAGMA user_version = " + std::to_string(kFormat));
}

}  // namespace talus::costmap
