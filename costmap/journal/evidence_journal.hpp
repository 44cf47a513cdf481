#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <talus/costmap/evidence/wheel_observation.hpp>

namespace talus::costmap {

class JournalDatabase;

/// EVIDENCE.db: every telemetry row ever offered to a map, drive by drive, in SQLite (write-ahead log). A drive is
/// taken in once, whatever its file is called, and as a whole or not at all, synced before append() or
/// Transaction::commit() returns. Several processes may share one journal; they queue. One object a thread.
class EvidenceJournal {
 public:
  /// Holds the journal from its making on: what is appended stays only after commit(). Throws InputError when another
  /// process holds it for longer than 30 s.
  class Transaction {
   public:
    explicit Transaction(EvidenceJournal& journal);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

   private:
    EvidenceJournal* journal_;  // null once committed
  };

  /// Opens or creates a file of that very name: no URI, no database in memory. A journal of Talus 0.1.0 becomes of the
  /// present format. Throws InputError when the file is no journal, is of another format, has tables, columns, triggers or
  /// views that a journal has not, or cannot be written.
  explicit EvidenceJournal(const std::string& path);
  ~EvidenceJournal();
  EvidenceJournal(const EvidenceJournal&) = delete;
  EvidenceJournal& operator=(const EvidenceJournal&) = delete;

  /// Appends the rows of a drive, its id by driveId(), in a transaction of its own where none is open; nothing where the journal holds the
  /// drive already. `continued`: the id that the drive had without these rows, if it is in the journal. Throws
  /// InputError when the disk is full or another process holds the file for longer than 30 s, std::invalid_argument when
  /// the id is not of 16 hexadecimal digits.
  void append(const std::string& drive, const std::vector<JournalRow>& rows,
              const std::string& continued = {});

  /// Puts rows in the place of those of a drive that the journal holds, in a transaction of its own where none is open.
  void replace(const std::string& drive, const std::vector<JournalRow>& rows);

  /// Ids of its drives, in the order in which they were appended. Throws InputError when a drive or a drive's entry is
  /// missing, or an id is none.
  std::vector<std::string> drives() const;

  /// Throws InputError unless the journal has the drive, its rows and its id as they were written. Returns its number.
  std::int64_t check(const std::string& drive) const;

  /// The rows of a drive in order, numbers to the bit. Throws InputError where check() does, or when a row holds a number
  /// that no wheel can give.
  std::vector<JournalRow> rows(const std::string& drive) const;

  /// Rows that it holds.
  std::int64_t size() const;

 private:
  std::unique_ptr<JournalDatabase> database_;
};

}  // namespace talus::costmap
