#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <talus/costmap/evidence/evidence.hpp>

struct sqlite3;
struct sqlite3_stmt;

namespace talus::costmap {

/// An open SQLite file of a journal. Errors of SQLite are thrown as InputError with the file name. An object
/// must not be used by several threads.
class JournalDatabase {
 public:
  struct Close {
    void operator()(sqlite3* database) const noexcept;
    void operator()(sqlite3_stmt* statement) const noexcept;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Close>;

  /// Opens or creates the file `path`; URIs and in-memory databases are not accepted. Throws InputError if
  /// the file is not an SQLite file or cannot be opened.
  explicit JournalDatabase(const std::string& path);

  const std::string& path() const noexcept { return path_; }
  bool inTransaction() const noexcept;
  std::int64_t lastRow() const noexcept;

  /// Compiles an SQL statement.
  Statement prepare(const char* sql) const;
  /// Executes a step of a statement. Returns true if the step produced a row.
  bool step(const Statement& statement) const;
  void run(const std::string& sql) const;
  /// Returns the first number of the result of a query, or 0 if the result has no row; closes the query.
  std::int64_t single(const char* sql) const;
  void rollBack() const noexcept;

  /// Throws an InputError which states that the journal differs from its written state, with the reason.
  [[noreturn]] void refuse(const std::string& reason) const;

 private:
  [[noreturn]] void fail() const;

  std::string path_;
  std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace talus::costmap
namespace talus::costmap {

/// Enables the write-ahead log and marks a new file as a journal. Throws InputError for another SQLite file.
void beginJournal(const JournalDatabase& database);

/// Creates the tables of a new journal. Requires that the file has no other
/// tables, triggers or views, because a trigger or view could drop rows without an error. Must be called
/// within a transaction. Throws InputError, also for other formats.
void bringUpToDate(const JournalDatabase& database);

/// Functions that read and write the rows of the tables `evidence` and `drive` of a journal.

/// Returns the text of a column of a result row, zero bytes included.
std::string journalText(sqlite3_stmt* row, int column);

/// Appends rows to the drive with the number `drive`.
void insertRows(const JournalDatabase& database, std::int64_t drive, const std::vector<JournalRow>& rows);

/// Returns the rows of a drive, in order.
std::vector<JournalRow> selectRows(const JournalDatabase& database, std::int64_t drive);

/// Lower bound of the ids of all rows, also in a modified journal.
constexpr std::int64_t kBeforeAllRows = std::numeric_limits<std::int64_t>::min();

/// Returns the chained checksum of the rows of a drive whose id is above `after`. `before` is the checksum of
/// the earlier rows; 0 if there are no earlier rows.
std::uint64_t rowsChecksum(const JournalDatabase& database, std::int64_t drive, std::uint64_t before,
                           std::int64_t after);

/// Entry of a drive in the table `drive`. The stored checksum combines the checksum of the rows with the
/// number and id of the drive (sealed()), so that an exchange of any of these is detected.
struct DriveEntry {
  std::int64_t number = 0;
  std::string id;
  std::uint64_t checksum = 0;  ///< checksum of the rows
};

/// Returns the stored checksum of an entry with the checksum of the rows, or vice versa: XOR with a hash of
/// number and id.
std::uint64_t sealed(const DriveEntry& entry);

/// Returns true if the id has 16 hexadecimal digits, like DriveId.
bool isDriveId(const std::string& id);

}  // namespace talus::costmap
