#pragma once

#include <cstdint>
#include <memory>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace talus::costmap {

/// An open SQLite file of a journal. What SQLite refuses is an InputError that names the file. One object a thread.
class JournalDatabase {
 public:
  struct Close {
    void operator()(sqlite3* database) const noexcept;
    void operator()(sqlite3_stmt* statement) const noexcept;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Close>;

  /// Opens or creates a file of that very name: neither URIs nor databases in memory. Throws InputError when it is
  /// another file than SQLite's or cannot be opened.
  explicit JournalDatabase(const std::string& path);

  const std::string& path() const noexcept { return path_; }
  bool inTransaction() const noexcept;
  std::int64_t lastRow() const noexcept;

  Statement prepare(const char* sql) const;
  /// Whether a statement gave one more row.
  bool step(const Statement& statement) const;
  void run(const std::string& sql) const;
  /// The first number of a query's answer; nothing of the query stays open.
  std::int64_t single(const char* sql) const;
  void rollBack() const noexcept;

  /// Throws InputError: the journal is not as it was written.
  [[noreturn]] void refuse(const std::string& reason) const;

 private:
  [[noreturn]] void fail() const;

  std::string path_;
  std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace talus::costmap
