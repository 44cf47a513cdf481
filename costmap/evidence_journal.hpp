#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <talus/costmap/wheel_observation.hpp>

struct sqlite3;
struct sqlite3_stmt;

namespace talus::costmap {

/// One telemetry row as the journal keeps it.
struct JournalRow {
  std::string source;            ///< file or vehicle it came from
  std::int64_t line = 0;         ///< in the file
  bool accepted = false;         ///< whether the map learned from it
  std::string reason;            ///< why not; empty when accepted
  WheelReading reading;          ///< as read
  WheelObservation observation;  ///< what it said; of no meaning when refused
};

/// EVIDENCE.db: every telemetry row ever offered to a map, in order, in SQLite (write-ahead log). Each row is
/// a transaction of its own, synced before append() returns: a killed process or a power cut loses at most
/// the row being written. Several processes may append to one journal; rows keep the order of their numbers.
/// One object a thread.
class EvidenceJournal {
 public:
  /// Opens or creates. Throws InputError when the file is no journal or cannot be written.
  explicit EvidenceJournal(const std::string& path);
  ~EvidenceJournal();
  EvidenceJournal(const EvidenceJournal&) = delete;
  EvidenceJournal& operator=(const EvidenceJournal&) = delete;

  /// Appends a row. Throws InputError when the disk is full or another process holds the file for longer than
  /// 30 s.
  void append(const JournalRow& row);

  /// Visits every row in order. Numbers come back to the bit.
  void forEach(const std::function<void(const JournalRow&)>& visit) const;

  /// Rows that it holds.
  std::int64_t size() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const noexcept;
    void operator()(sqlite3_stmt* statement) const noexcept;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Close>;

  Statement prepare(const char* sql) const;
  void run(const char* sql) const;
  void upgrade();
  std::int64_t single(const char* sql) const;
  [[noreturn]] void fail() const;

  std::string path_;
  std::unique_ptr<sqlite3, Close> database_;
  Statement insert_;
};

}  // namespace talus::costmap
