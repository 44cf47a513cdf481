#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <sqlite3.h>

#include <talus/common/input_error.hpp>
#include <talus/common/input_file.hpp>
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

}  // namespace talus::costmap
