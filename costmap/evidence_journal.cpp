#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include <sqlite3.h>

#include <talus/costmap/checksum.hpp>
#include <talus/costmap/evidence_journal.hpp>
#include <talus/talus.hpp>

namespace talus::costmap {
namespace {

// 1 had no z_m, 2 no pose_std_m nor what may raise, 3 no drives, 4 no bounds, 5 no shared errors nor wheels, 6 no share of
// the thrust: a pull that was read at little slip counted as if it had been read at the reference slip
constexpr int kFormat = 7;
constexpr int kApplication = 0x54414c55;  // "TALU"

constexpr const char* kSchema =
    "CREATE TABLE IF NOT EXISTS evidence(id INTEGER PRIMARY KEY AUTOINCREMENT, source TEXT NOT NULL, line "
    "INTEGER NOT NULL,"
    " accepted INTEGER NOT NULL, reason TEXT NOT NULL, time_s REAL, x_m REAL, y_m REAL, load_N REAL, slip "
    "REAL,"
    " torque_Nm REAL, sinkage_m REAL, gradient REAL, drawbar_pull_N REAL, pass_index INTEGER,"
    " pull REAL, pull_std REAL, sinkage REAL, sinkage_std REAL, z_m REAL,"
    " pose_std_m REAL NOT NULL DEFAULT 0, pull_may_raise INTEGER NOT NULL DEFAULT 0,"
    " sinkage_may_raise INTEGER NOT NULL DEFAULT 0, drive INTEGER, pull_here REAL, sinkage_here REAL,"
    " pull_shared_std REAL, wheel_radius_m REAL, wheel_width_m REAL, wheel_weight_N REAL, thrust_share REAL);"
    "CREATE TABLE IF NOT EXISTS drive(number INTEGER PRIMARY KEY, id TEXT NOT NULL UNIQUE, checksum INTEGER)";
constexpr const char* kInsert =
    "INSERT INTO evidence(source, line, accepted, reason, time_s, x_m, y_m, load_N, slip, torque_Nm, "
    "sinkage_m, gradient,"
    " drawbar_pull_N, pass_index, pull, pull_std, sinkage, sinkage_std, z_m, pose_std_m,"
    " pull_may_raise, sinkage_may_raise, pull_here, sinkage_here, pull_shared_std, wheel_radius_m, "
    "wheel_width_m, wheel_weight_N, thrust_share, drive) "
    "VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)";
constexpr const char* kSelect =
    "SELECT source, line, accepted, reason, time_s, x_m, y_m, load_N, slip, torque_Nm, sinkage_m, gradient,"
    " drawbar_pull_N, pass_index, pull, pull_std, sinkage, sinkage_std, z_m, pose_std_m,"
    " pull_may_raise, sinkage_may_raise, pull_here, sinkage_here, pull_shared_std, wheel_radius_m, "
    "wheel_width_m, wheel_weight_N, thrust_share FROM evidence WHERE drive = ? AND id > ? ORDER BY id";

// Columns that older journals lack: what they hold may not raise.
constexpr std::array<std::pair<const char*, const char*>, 12> kAdded{
    {{"z_m", "REAL"},
     {"pose_std_m", "REAL NOT NULL DEFAULT 0"},
     {"pull_may_raise", "INTEGER NOT NULL DEFAULT 0"},
     {"sinkage_may_raise", "INTEGER NOT NULL DEFAULT 0"},
     {"drive", "INTEGER"},
     {"pull_here", "REAL"},
     {"sinkage_here", "REAL"},
     {"pull_shared_std", "REAL"},
     {"wheel_radius_m", "REAL"},
     {"wheel_width_m", "REAL"},
     {"wheel_weight_N", "REAL"},
     {"thrust_share", "REAL"}}};

// NULL stands for NaN: SQLite has none. What is no number, "0" for SQLite, is refused by fault().
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

std::string text(sqlite3_stmt* row, int column) {
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return bytes ? std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(row, column))) : "";
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
                     .shared_std = number(row, 24),
                     .share = number(row, 28),
                     .pose_std_m = out.reading.pose_std_m,
                     .pull_may_raise = sqlite3_column_int(row, 20) != 0,
                     .sinkage_may_raise = sqlite3_column_int(row, 21) != 0,
                     .here = {number(row, 22), number(row, 23)}};
  if (std::isnan(out.observation.share)) out.observation.shared_std = out.observation.share;
  out.wheel = {number(row, 25), number(row, 26), number(row, 27)};
  return out;
}

}  // namespace

void EvidenceJournal::Close::operator()(sqlite3* database) const noexcept {
  sqlite3_close(database);
}
void EvidenceJournal::Close::operator()(sqlite3_stmt* statement) const noexcept {
  sqlite3_finalize(statement);
}

namespace {

// SQLite takes a file of a few bytes for a new database: the drives of one that was cut would be lost in silence.
void requireJournalOrNothing(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    throw InputError({path, "is a folder, a device, a FIFO or a socket", "give a file"});
  const std::uintmax_t size = fs::file_size(path, error);
  if (error || size == 0) return;
  constexpr std::string_view kStart("SQLite format 3\0", 16);
  std::array<char, kStart.size()> start{};
  std::ifstream(path, std::ios::binary).read(start.data(), start.size());
  if (std::string_view(start.data(), start.size()) != kStart)
    throw InputError(
        {path, "is no evidence journal, or was cut", "name the journal, or a file that does not exist"});
}

}  // namespace

EvidenceJournal::EvidenceJournal(const std::string& path) : path_(path) {
  requireJournalOrNothing(path);
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
  upgrade();
  insert_ = prepare(kInsert);
}

// Under a lock, so that two processes do not both add the column.
void EvidenceJournal::upgrade() {
  Transaction transaction(*this);
  const std::int64_t format = single("PRAGMA user_version");
  if (format > kFormat)
    throw InputError({path_,
                      "an evidence journal of format " + std::to_string(format) + ", newer than " +
                          std::to_string(kFormat),
                      "use the program that wrote it"});
  if (format == kFormat) return;
  run(kSchema);
  for (const auto& [name, type] : kAdded)
    if (single(("SELECT count(*) FROM pragma_table_info('evidence') WHERE name = '" + std::string(name) + "'")
                   .c_str()) == 0)
      run(("ALTER TABLE evidence ADD COLUMN " + std::string(name) + ' ' + type).c_str());
  adopt();
  run("CREATE INDEX IF NOT EXISTS of_drive ON evidence(drive)");
  run(("PRAGMA user_version = " + std::to_string(kFormat)).c_str());
  transaction.commit();
}

// Rows from before there were drives: what one source gave is taken for one drive.
void EvidenceJournal::adopt() {
  run("INSERT INTO drive(id) SELECT 'source ' || source FROM evidence WHERE drive IS NULL GROUP BY source "
      "ORDER BY min(id)");
  run("UPDATE evidence SET drive = (SELECT number FROM drive WHERE drive.id = 'source ' || evidence.source) "
      "WHERE drive IS NULL");
}

EvidenceJournal::Transaction::Transaction(EvidenceJournal& journal) : journal_(&journal) {
  journal.run("BEGIN IMMEDIATE");
}

EvidenceJournal::Transaction::~Transaction() {
  if (journal_) sqlite3_exec(journal_->database_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void EvidenceJournal::Transaction::commit() {
  journal_->run("COMMIT");
  journal_ = nullptr;
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

namespace {

void bindRow(sqlite3_stmt* s, const JournalRow& row, std::int64_t drive) {
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
  sqlite3_bind_int(s, at++, o.sinkage_may_raise ? 1 : 0);
  bind(s, at++, o.here.most_pull);
  bind(s, at++, o.here.least_sinkage);
  for (const double value :
       {o.shared_std, row.wheel.radius_m, row.wheel.width_m, row.wheel.weight_N, o.share})
    bind(s, at++, value);
  sqlite3_bind_int64(s, at, drive);
}

// Column by column with its kind; NULL is left out, so that a column added later, NULL in older rows, changes nothing.
void addTo(Checksum& sum, sqlite3_stmt* row) {
  for (int column = 0; column < sqlite3_column_count(row); ++column) {
    const std::int32_t mark[2] = {column, sqlite3_column_type(row, column)};
    if (mark[1] == SQLITE_NULL) continue;
    sum.add(mark, sizeof mark);
    const double real = sqlite3_column_double(row, column);
    const std::int64_t integer = sqlite3_column_int64(row, column);
    if (mark[1] == SQLITE_FLOAT)
      sum.add(&real, sizeof real);
    else if (mark[1] == SQLITE_INTEGER)
      sum.add(&integer, sizeof integer);
    else
      sum.add(text(row, column).data(), static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
  }
}

}  // namespace

struct EvidenceJournal::Drive {
  std::int64_t number = 0;                // 0: none
  std::optional<std::uint64_t> checksum;  // of its rows, each after those before it; nothing in older formats
};

EvidenceJournal::Drive EvidenceJournal::find(const std::string& id) const {
  const auto entry = prepare("SELECT number, checksum FROM drive WHERE id = ?");
  sqlite3_bind_text(entry.get(), 1, id.c_str(), -1, SQLITE_TRANSIENT);
  const int result = sqlite3_step(entry.get());
  if (result == SQLITE_DONE) return {};
  if (result != SQLITE_ROW) fail();
  Drive drive{.number = sqlite3_column_int64(entry.get(), 0), .checksum = {}};
  if (sqlite3_column_type(entry.get(), 1) != SQLITE_NULL)
    drive.checksum = static_cast<std::uint64_t>(sqlite3_column_int64(entry.get(), 1));
  return drive;
}

void EvidenceJournal::checksum(Drive& drive, std::int64_t after) const {
  const auto rows = prepare(kSelect);
  sqlite3_bind_int64(rows.get(), 1, drive.number);
  sqlite3_bind_int64(rows.get(), 2, after);
  int result = SQLITE_ROW;
  while ((result = sqlite3_step(rows.get())) == SQLITE_ROW) {
    Checksum sum;
    sum.add(&*drive.checksum, sizeof *drive.checksum);
    addTo(sum, rows.get());
    drive.checksum = sum.value();
  }
  if (result != SQLITE_DONE) fail();
}

void EvidenceJournal::append(const std::string& drive, const std::vector<JournalRow>& rows,
                             const std::string& continued) {
  std::optional<Transaction> own;
  if (sqlite3_get_autocommit(database_.get()) != 0) own.emplace(*this);
  if (find(drive).number != 0) return;
  Drive entry = find(continued);
  if (entry.number == 0) {
    run("INSERT INTO drive(id) VALUES('')");
    entry = {.number = sqlite3_last_insert_rowid(database_.get()), .checksum = 0};
  }
  write(entry, drive, rows);
  if (own) own->commit();
}

void EvidenceJournal::replace(const std::string& drive, const std::vector<JournalRow>& rows) {
  std::optional<Transaction> own;
  if (sqlite3_get_autocommit(database_.get()) != 0) own.emplace(*this);
  const Drive entry = find(drive);
  if (entry.number == 0) return;
  const auto taken = prepare("DELETE FROM evidence WHERE drive = ?");
  sqlite3_bind_int64(taken.get(), 1, entry.number);
  if (sqlite3_step(taken.get()) != SQLITE_DONE) fail();
  write({.number = entry.number, .checksum = 0}, drive, rows);
  if (own) own->commit();
}

// Rows behind those that the drive has, and its id with them.
void EvidenceJournal::write(Drive entry, const std::string& id, const std::vector<JournalRow>& rows) {
  const std::int64_t before = single("SELECT ifnull(max(id), 0) FROM evidence");
  for (const JournalRow& row : rows) {
    bindRow(insert_.get(), row, entry.number);
    const int result = sqlite3_step(insert_.get());
    sqlite3_reset(insert_.get());
    if (result != SQLITE_DONE) fail();
  }
  if (entry.checksum) checksum(entry, before);
  const auto close = prepare("UPDATE drive SET id = ?, checksum = ? WHERE number = ?");
  sqlite3_bind_text(close.get(), 1, id.c_str(), -1, SQLITE_TRANSIENT);
  if (entry.checksum) sqlite3_bind_int64(close.get(), 2, static_cast<std::int64_t>(*entry.checksum));
  sqlite3_bind_int64(close.get(), 3, entry.number);
  if (sqlite3_step(close.get()) != SQLITE_DONE) fail();
}

std::vector<std::string> EvidenceJournal::drives() const {
  if (single("SELECT count(*) FROM evidence WHERE drive NOT IN (SELECT number FROM drive)") != 0)
    throw InputError({path_, "holds rows of a drive that is not listed: the journal was changed",
                      "restore the journal from a copy"});
  const auto rows = prepare("SELECT id FROM drive ORDER BY number");
  std::vector<std::string> ids;
  int result = SQLITE_ROW;
  while ((result = sqlite3_step(rows.get())) == SQLITE_ROW) ids.push_back(text(rows.get(), 0));
  if (result != SQLITE_DONE) fail();
  return ids;
}

std::vector<JournalRow> EvidenceJournal::rows(const std::string& drive) const {
  const auto refuse = [&](const std::string& reason) {
    throw InputError({path_ + ", drive " + drive, reason, "restore the journal from a copy"});
  };
  const Drive entry = find(drive);
  if (entry.number == 0) return {};
  if (entry.checksum) {
    Drive again{.number = entry.number, .checksum = 0};
    checksum(again, 0);
    if (again.checksum != entry.checksum)
      refuse("its rows were changed since they were written: checksum mismatch");
  }
  const auto rows = prepare(kSelect);
  sqlite3_bind_int64(rows.get(), 1, entry.number);
  sqlite3_bind_int64(rows.get(), 2, 0);
  std::vector<JournalRow> out;
  int result = SQLITE_ROW;
  while ((result = sqlite3_step(rows.get())) == SQLITE_ROW) {
    out.push_back(readRow(rows.get()));
    const std::string reason = out.back().accepted ? fault(out.back().observation) : "";
    if (!reason.empty()) refuse("row of line " + std::to_string(out.back().line) + ": " + reason);
  }
  if (result != SQLITE_DONE) fail();
  return out;
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
