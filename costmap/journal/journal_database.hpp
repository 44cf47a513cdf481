#pragma once

#include <cstdint>
#include <memory>
#include <string>

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
