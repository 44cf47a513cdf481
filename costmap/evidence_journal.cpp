#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <sqlite3.h>

#include <talus/costmap/evidence_journal.hpp>
#include <talus/talus.hpp>

namespace talus::costmap {
namespace {

constexpr int kFormat = 3;                // 1 had no z_m, 2 no pose_std_m nor what may raise
constexpr int kApplication = 0x54414c55;  // "TALU"

constexpr const char* kSchema =
    "CREATE TABLE IF NOT EXISTS evidence(id INTEGER PRIMARY KEY AUTOINCREMENT, source TEXT NOT NULL, line "
    "INTEGER NOT NULL,"
    " accepted INTEGER NOT NULL, reason TEXT NOT NULL, time_s REAL, x_m REAL, y_m REAL, load_N REAL, slip "
    "REAL,"
    " torque_Nm REAL, sinkage_m REAL, gradient REAL, drawbar_pull_N REAL, pass_index INTEGER,"
    " pull REAL, pull_std REAL, sinkage REAL, sinkage_std REAL, z_m REAL,"
    " pose_std_m REAL NOT NULL DEFAULT 0, pull_may_raise INTEGER NOT NULL DEFAULT 0,"
    " sinkage_may_raise INTEGER NOT NULL DEFAULT 0)";
constexpr const char* kInsert =
    "INSERT INTO evidence(source, line, accepted, reason, time_s, x_m, y_m, load_N, slip, torque_Nm, "
    "sinkage_m, gradient,"
    " drawbar_pull_N, pass_index, pull, pull_std, sinkage, sinkage_std, z_m, pose_std_m,"
    " pull_may_raise, sinkage_may_raise) "
    "VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)";
constexpr const char* kSelect =
    "SELECT source, line, accepted, reason, time_s, x_m, y_m, load_N, slip, torque_Nm, sinkage_m, gradient,"
    " drawbar_pull_N, pass_index, pull, pull_std, sinkage, sinkage_std, z_m, pose_std_m,"
    " pull_may_raise, sinkage_may_raise FROM evidence ORDER BY id";

// Columns that older journals lack: what they hold may not raise.
constexpr std::array<std::pair<const char*, const char*>, 4> kAdded{
    {{"z_m", "REAL"},
     {"pose_std_m", "REAL NOT NULL DEFAULT 0"},
     {"pull_may_raise", "INTEGER NOT NULL DEFAULT 0"},
     {"sinkage_may_raise", "INTEGER NOT NULL DEFAULT 0"}}};

// NULL stands for NaN: SQLite has none.
double number(sqlite3_stmt* row, int column) {
  return sqlite3_column_type(row, column) == SQLITE_NULL ? std::numeric_limits<double>::quiet_NaN()
                                                         : sqlite3_column_double(row, column);
}

void bind(sqlite3_stmt* statement, int at, double value) {
  if (std::isnan(value))
    sqlite3_bind_null(statement, at);
  else
    sqlite3_bind_double(statement, at, value);
}

std::string text(sqlite3_stmt* row, int column) {
  return reinterpret_cast<const char*>(sqlite3_column_text(row, column));
}

JournalRow readRow(sqlite3_stmt* row) {
  JournalRow out{.source = text(row, 0),
                 .line = sqlite3_column_int64(row, 1),
                 .accepted = sqlite3_column_int(row, 2) != 0,
                 .reason = text(row, 3),
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
                     .z_m = out.reading.z_m,
                     .pull = {number(row, 14), number(row, 15)},
                     .sinkage = {number(row, 16), number(row, 17)},
                     .demand = out.reading.gradient,
                     .from_torque = std::numeric_limits<double>::quiet_NaN(),
                     .pose_std_m = out.reading.pose_std_m,
                     .pull_may_raise = sqlite3_column_int(row, 20) != 0,
                     .sinkage_may_raise = sqlite3_column_int(row, 21) != 0};
  return out;
}

}  // namespace

void EvidenceJournal::Close::operator()(sqlite3* database) const noexcept {
  sqlite3_close(database);
}
void EvidenceJournal::Close::operator()(sqlite3_stmt* statement) const noexcept {
  sqlite3_finalize(statement);
}

EvidenceJournal::EvidenceJournal(const std::string& path) : path_(path) {
  sqlite3* opened = nullptr;
  const int result = sqlite3_open(path.c_str(), &opened);
  database_.reset(opened);
  if (result != SQLITE_OK) fail();
  sqlite3_busy_timeout(opened, 30'000);
  const std::int64_t application = single("PRAGMA application_id");
  if (application != kApplication && single("SELECT count(*) FROM sqlite_master") > 0)
    throw InputError({path_, "an SQLite file, but no evidence journal", "name another file"});
  run("PRAGMA journal_mode = WAL");
  run("PRAGMA synchronous = FULL");
  if (application != kApplication) {
    // The mark comes before the table: a process killed in between leaves a journal, if an empty one.
    run(("PRAGMA application_id = " + std::to_string(kApplication)).c_str());
  }
  run(kSchema);
  upgrade();
  insert_ = prepare(kInsert);
}

// Under a lock, so that two processes do not both add the column.
void EvidenceJournal::upgrade() {
  run("BEGIN IMMEDIATE");
  const std::int64_t format = single("PRAGMA user_version");
  if (format > kFormat)
    throw InputError({path_,
                      "an evidence journal of format " + std::to_string(format) + ", newer than " +
                          std::to_string(kFormat),
                      "use the program that wrote it"});
  for (const auto& [name, type] : kAdded)
    if (single(("SELECT count(*) FROM pragma_table_info('evidence') WHERE name = '" + std::string(name) + "'")
                   .c_str()) == 0)
      run(("ALTER TABLE evidence ADD COLUMN " + std::string(name) + ' ' + type).c_str());
  run(("PRAGMA user_version = " + std::to_string(kFormat)).c_str());
  run("COMMIT");
}

EvidenceJournal::~EvidenceJournal() = default;

EvidenceJournal::Statement EvidenceJournal::prepare(const char* sql) const {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr) != SQLITE_OK) fail();
  return Statement(statement);
}

void EvidenceJournal::run(const char* sql) const {
  if (sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

void EvidenceJournal::fail() const {
  throw InputError(
      {path_, std::string("evidence journal: ") + (database_ ? sqlite3_errmsg(database_.get()) : "no memory"),
       "check that it is a journal and that its folder can be written"});
}

void EvidenceJournal::append(const JournalRow& row) {
  sqlite3_stmt* s = insert_.get();
  sqlite3_bind_text(s, 1, row.source.c_str(), -1, SQLITE_TRANSIENT);
  sqlite3_bind_int64(s, 2, row.line);
  sqlite3_bind_int(s, 3, row.accepted ? 1 : 0);
  sqlite3_bind_text(s, 4, row.reason.c_str(), -1, SQLITE_TRANSIENT);
  const WheelReading& r = row.reading;
  const WheelObservation& o = row.observation;
  int at = 5;
  for (const double value : {r.time_s, r.place.x_m, r.place.y_m, r.load_N, r.slip, r.torque_Nm, r.sinkage_m,
                             r.gradient, r.drawbar_pull_N})
    bind(s, at++, value);
  sqlite3_bind_int(s, at++, r.pass);
  for (const double value : {o.pull.value, o.pull.std, o.sinkage.value, o.sinkage.std, r.z_m, r.pose_std_m})
    bind(s, at++, value);
  sqlite3_bind_int(s, at++, o.pull_may_raise ? 1 : 0);
  sqlite3_bind_int(s, at, o.sinkage_may_raise ? 1 : 0);
  const int result = sqlite3_step(s);
  sqlite3_reset(s);
  if (result != SQLITE_DONE) fail();
}

void EvidenceJournal::forEach(const std::function<void(const JournalRow&)>& visit) const {
  const auto rows = prepare(kSelect);
  int result = SQLITE_ROW;
  while ((result = sqlite3_step(rows.get())) == SQLITE_ROW) visit(readRow(rows.get()));
  if (result != SQLITE_DONE) fail();
}

// The first number of a query's answer; nothing of the query stays open.
std::int64_t EvidenceJournal::single(const char* sql) const {
  const auto rows = prepare(sql);
  if (sqlite3_step(rows.get()) != SQLITE_ROW) fail();
  return sqlite3_column_int64(rows.get(), 0);
}

std::int64_t EvidenceJournal::size() const {
  return single("SELECT count(*) FROM evidence");
}

}  // namespace talus::costmap
