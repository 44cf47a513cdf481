#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <sqlite3.h>

#include <talus/common/checksum.hpp>
#include <talus/costmap/journal/journal_rows.hpp>

namespace talus::costmap {
namespace {

constexpr const char* kInsert =
    "INSERT INTO evidence(source, line, accepted, reason, time_s, x_m, y_m, load_N, slip, torque_Nm, "
    "sinkage_m, gradient,"
    " drawbar_pull_N, pass_index, pull, pull_std, sinkage, sinkage_std, z_m, pose_std_m,"
    " pull_may_raise, sinkage_may_raise, pull_here, sinkage_here, pull_shared_std, wheel_radius_m, "
    "wheel_width_m, wheel_weight_N, thrust_share, drive_tag, drive) "
    "VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)";
constexpr const char* kSelect =
    "SELECT source, line, accepted, reason, time_s, x_m, y_m, load_N, slip, torque_Nm, sinkage_m, gradient,"
    " drawbar_pull_N, pass_index, pull, pull_std, sinkage, sinkage_std, z_m, pose_std_m,"
    " pull_may_raise, sinkage_may_raise, pull_here, sinkage_here, pull_shared_std, wheel_radius_m, "
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
                     .demand = out.reading.gradient,
                     .from_torque = std::numeric_limits<double>::quiet_NaN(),
                     .shared_std = number(row, 24),
                     .share = number(row, 28),
                     .pose_std_m = out.reading.pose_std_m,
                     .trust = static_cast<Trust>(std::clamp(sqlite3_column_int(row, 20), 0, 2)),
                     .sinkage_verified = sqlite3_column_int(row, 21) != 0,
                     .drive = static_cast<std::uint16_t>(sqlite3_column_int(row, 29)),
                     .here = {number(row, 22), number(row, 23)}};
  out.wheel = {number(row, 25), number(row, 26), number(row, 27)};
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
  sqlite3_bind_int(s, at++, o.sinkage_verified ? 1 : 0);
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
