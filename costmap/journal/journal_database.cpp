#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <sqlite3.h>

#include <talus/common/checksum.hpp>
#include <talus/common/common.hpp>
#include <talus/costmap/journal/journal_database.hpp>

namespace talus::costmap {

namespace {

// Rejects names that SQLite interprets as an in-memory database or a URI, whose rows would be lost with the
// process.
void requireFileName(const std::string& path) {
  if (path.empty()) throw InputError({"evidence journal", "its name is empty", "name a file"});
  if (path == ":memory:" || path.starts_with("file:"))
    throw InputError({path, "a name that SQLite takes for memory or a URI, not for a file",
                      "name a file, or ./" + path + " if it is one"});
  if (path.back() == '/') throw InputError({path, "is the name of a folder", "name a file"});
}

// Rejects truncated files: SQLite treats a file of a few bytes as a new database and would silently discard
// the drives.
void requireJournalOrNothing(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    throw InputError({path, "is a folder, a device, a FIFO or a socket", "give a file"});
  const std::uintmax_t size = fs::file_size(path, error);
  if (error || size == 0) return;
  checkInput(path);
  constexpr std::string_view kStart("SQLite format 3\0", 16);
  std::array<char, kStart.size()> start{};
  std::ifstream(path, std::ios::binary).read(start.data(), start.size());
  if (std::string_view(start.data(), start.size()) != kStart)
    throw InputError(
        {path, "is no evidence journal, or was cut", "name the journal, or a file that does not exist"});
}

// Replaces unprintable bytes: SQLite's messages contain names from a possibly damaged file.
std::string printable(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
  return text;
}

}  // namespace

void JournalDatabase::Close::operator()(sqlite3* database) const noexcept {
  sqlite3_close(database);
}
void JournalDatabase::Close::operator()(sqlite3_stmt* statement) const noexcept {
  sqlite3_finalize(statement);
}

JournalDatabase::JournalDatabase(const std::string& path) : path_(path) {
  requireFileName(path);
  requireJournalOrNothing(path);
  sqlite3* opened = nullptr;
  const int result =
      sqlite3_open_v2(path.c_str(), &opened, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  database_.reset(opened);
  if (result != SQLITE_OK) fail();
  constexpr int kWait_ms = 30'000;
  sqlite3_busy_timeout(opened, kWait_ms);
}

bool JournalDatabase::inTransaction() const noexcept {
  return sqlite3_get_autocommit(database_.get()) == 0;
}

std::int64_t JournalDatabase::lastRow() const noexcept {
  return sqlite3_last_insert_rowid(database_.get());
}

JournalDatabase::Statement JournalDatabase::prepare(const char* sql) const {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr) != SQLITE_OK) fail();
  return Statement(statement);
}

bool JournalDatabase::step(const Statement& statement) const {
  const int result = sqlite3_step(statement.get());
  if (result != SQLITE_ROW && result != SQLITE_DONE) fail();
  return result == SQLITE_ROW;
}

void JournalDatabase::run(const std::string& sql) const {
  if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

std::int64_t JournalDatabase::single(const char* sql) const {
  const Statement rows = prepare(sql);
  return step(rows) ? sqlite3_column_int64(rows.get(), 0) : 0;
}

void JournalDatabase::rollBack() const noexcept {
  sqlite3_exec(database_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void JournalDatabase::refuse(const std::string& reason) const {
  throw InputError({path_, reason, "restore the journal from a copy"});
}

void JournalDatabase::fail() const {
  throw InputError(
      {path_, "evidence journal: " + printable(database_ ? sqlite3_errmsg(database_.get()) : "no memory"),
       "check that it is a journal and that its folder can be written"});
}

namespace {

constexpr int kFormat = 11;
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
       " pose_std_m REAL NOT NULL DEFAULT 0, trust INTEGER NOT NULL DEFAULT 0,"
       " drive INTEGER, pull_here REAL, sinkage_here REAL, "
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

namespace {

constexpr const char* kInsert =
    "INSERT INTO evidence(source, line, accepted, reason, time_s, x_m, y_m, load_N, slip, torque_Nm, "
    "sinkage_m, gradient,"
    " drawbar_pull_N, pass_index, pull, pull_std, sinkage, sinkage_std, z_m, pose_std_m,"
    " trust, pull_here, sinkage_here, pull_shared_std, wheel_radius_m, "
    "wheel_width_m, wheel_weight_N, thrust_share, drive_tag, drive) "
    "VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)";
constexpr const char* kSelect =
    "SELECT source, line, accepted, reason, time_s, x_m, y_m, load_N, slip, torque_Nm, sinkage_m, gradient,"
    " drawbar_pull_N, pass_index, pull, pull_std, sinkage, sinkage_std, z_m, pose_std_m,"
    " trust, pull_here, sinkage_here, pull_shared_std, wheel_radius_m, "
    "wheel_width_m, wheel_weight_N, thrust_share, drive_tag FROM evidence WHERE drive = ? AND id > ? ORDER "
    "BY id";

// Returns NaN for NULL, because SQLite cannot store NaN, and infinity, which fault() rejects, for a value
// that is not a number; SQLite's own conversion would return 0.
double number(sqlite3_stmt* row, int column) {
  const int type = sqlite3_column_type(row, column);
  if (type == SQLITE_NULL) return std::numeric_limits<double>::quiet_NaN();
  return type == SQLITE_FLOAT || type == SQLITE_INTEGER ? sqlite3_column_double(row, column)
                                                        : std::numeric_limits<double>::infinity();
}

void bind(sqlite3_stmt* statement, int at, double value) {
  if (std::isnan(value))
    sqlite3_bind_null(statement, at);
  else
    sqlite3_bind_double(statement, at, value);
}

JournalRow readRow(sqlite3_stmt* row) {
  JournalRow out{.source = journalText(row, 0),
                 .line = sqlite3_column_int64(row, 1),
                 .accepted = sqlite3_column_int(row, 2) != 0,
                 .reason = journalText(row, 3),
                 .reading = {},
                 .observation = {}};
  out.reading = {.time_s = number(row, 4),
                 .place = {number(row, 5), number(row, 6)},
                 .z_m = number(row, 18),
                 .load_N = number(row, 7),
                 .slip = number(row, 8),
                 .torque_Nm = number(row, 9),
                 .sinkage_m = number(row, 10),
                 .gradient = number(row, 11),
                 .drawbar_pull_N = number(row, 12),
                 .pose_std_m = number(row, 19),
                 .pass = sqlite3_column_int(row, 13)};
  out.observation = {.time_s = out.reading.time_s,
                     .place = out.reading.place,
                     .pull = {number(row, 14), number(row, 15)},
                     .sinkage = {number(row, 16), number(row, 17)},
                     .shared_std = number(row, 23),
                     .share = number(row, 27),
                     .pose_std_m = out.reading.pose_std_m,
                     .trust = static_cast<Trust>(std::clamp(sqlite3_column_int(row, 20), 0, 2)),
                     .drive = static_cast<std::uint16_t>(sqlite3_column_int(row, 28)),
                     .here = {number(row, 21), number(row, 22)}};
  out.wheel = {number(row, 24), number(row, 25), number(row, 26)};
  return out;
}

void bindRow(sqlite3_stmt* s, const JournalRow& row, std::int64_t drive) {
  sqlite3_bind_text(s, 1, row.source.c_str(), -1, SQLITE_TRANSIENT);
  sqlite3_bind_int64(s, 2, row.line);
  sqlite3_bind_int(s, 3, row.accepted ? 1 : 0);
  sqlite3_bind_text(s, 4, row.reason.c_str(), -1, SQLITE_TRANSIENT);
  const TelemetryReading& r = row.reading;
  const WheelObservation& o = row.observation;
  int at = 5;
  for (const double value : {r.time_s, r.place.x_m, r.place.y_m, r.load_N, r.slip, r.torque_Nm, r.sinkage_m,
                             r.gradient, r.drawbar_pull_N})
    bind(s, at++, value);
  sqlite3_bind_int(s, at++, r.pass);
  for (const double value : {o.pull.value, o.pull.std, o.sinkage.value, o.sinkage.std, r.z_m, r.pose_std_m})
    bind(s, at++, value);
  sqlite3_bind_int(s, at++, static_cast<int>(o.trust));
  bind(s, at++, o.here.most_pull);
  bind(s, at++, o.here.least_sinkage);
  for (const double value :
       {o.shared_std, row.wheel.radius_m, row.wheel.width_m, row.wheel.weight_N, o.share})
    bind(s, at++, value);
  sqlite3_bind_int(s, at++, o.drive);
  sqlite3_bind_int64(s, at, drive);
}

template <typename T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Appends the columns with their types; NULL is omitted.
void append(std::string& bytes, sqlite3_stmt* row) {
  for (int column = 0; column < sqlite3_column_count(row); ++column) {
    const int type = sqlite3_column_type(row, column);
    if (type == SQLITE_NULL) continue;
    append(bytes, std::array<std::int32_t, 2>{column, type});
    if (type == SQLITE_FLOAT)
      append(bytes, sqlite3_column_double(row, column));
    else if (type == SQLITE_INTEGER)
      append(bytes, static_cast<std::int64_t>(sqlite3_column_int64(row, column)));
    else
      bytes += journalText(row, column);
  }
}

}  // namespace

std::string journalText(sqlite3_stmt* row, int column) {
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return bytes ? std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(row, column))) : "";
}

void insertRows(const JournalDatabase& database, std::int64_t drive, const std::vector<JournalRow>& rows) {
  const auto insert = database.prepare(kInsert);
  for (const JournalRow& row : rows) {
    bindRow(insert.get(), row, drive);
    database.step(insert);
    sqlite3_reset(insert.get());
  }
}

std::vector<JournalRow> selectRows(const JournalDatabase& database, std::int64_t drive) {
  const auto rows = database.prepare(kSelect);
  sqlite3_bind_int64(rows.get(), 1, drive);
  sqlite3_bind_int64(rows.get(), 2, kBeforeAllRows);
  std::vector<JournalRow> out;
  while (database.step(rows)) out.push_back(readRow(rows.get()));
  return out;
}

std::uint64_t rowsChecksum(const JournalDatabase& database, std::int64_t drive, std::uint64_t before,
                           std::int64_t after) {
  const auto rows = database.prepare(kSelect);
  sqlite3_bind_int64(rows.get(), 1, drive);
  sqlite3_bind_int64(rows.get(), 2, after);
  std::string bytes;
  while (database.step(rows)) {
    bytes.clear();
    append(bytes, before);
    append(bytes, rows.get());
    Checksum sum;
    sum.add(bytes.data(), bytes.size());
    before = sum.value();
  }
  return before;
}

std::uint64_t sealed(const DriveEntry& entry) {
  Checksum sum;
  sum.add(&entry.number, sizeof entry.number);
  sum.add(entry.id.data(), entry.id.size());
  return entry.checksum ^ sum.value();
}

bool isDriveId(const std::string& id) {
  constexpr std::size_t kDigits = 16;
  const auto digit = [](unsigned char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  return id.size() == kDigits && std::ranges::all_of(id, digit);
}

}  // namespace talus::costmap
