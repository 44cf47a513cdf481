#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <talus/costmap/evidence/evidence.hpp>

namespace talus::costmap {

class JournalDatabase;

/// Journal EVIDENCE.db: all telemetry rows that were offered to a map, by drive, in an SQLite file with a
/// write-ahead log. A drive is stored atomically and only once, whatever its file name, and is on the disk
/// before append() or Transaction::commit() returns. Several processes may use one journal; each waits for
/// the lock of the others. An object must not be used by several threads.
class EvidenceJournal {
 public:
  /// Write lock of the journal during the lifetime of the object. Changes are undone unless commit() is
  /// called. Throws InputError if another process keeps the lock for more than 30 s.
  class Transaction {
   public:
    explicit Transaction(EvidenceJournal& journal);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

   private:
    EvidenceJournal* journal_;  // journal; null after commit()
  };

  /// Opens or creates the file `path` (no URI, no in-memory database).
  /// Throws InputError if the file is not a journal, has another format, has foreign tables, columns,
  /// triggers or views, or cannot be written.
  explicit EvidenceJournal(const std::string& path);
  ~EvidenceJournal();
  EvidenceJournal(const EvidenceJournal&) = delete;
  EvidenceJournal& operator=(const EvidenceJournal&) = delete;

  /// Appends the rows of a drive with its identifier `drive` (DriveId), in a new transaction unless one is
  /// open. The call has no effect if the journal contains the drive. `continued` is the identifier of the
  /// drive without these rows, if the journal contains that drive. Throws InputError if the disk is full or
  /// if another process keeps the journal for more than 30 s, and std::invalid_argument for an invalid
  /// identifier (isDriveId()).
  void append(const std::string& drive, const std::vector<JournalRow>& rows,
              const std::string& continued = {});

  /// Replaces the rows of a drive, in a new transaction unless one is open. The call has no effect if the
  /// journal lacks the drive.
  void replace(const std::string& drive, const std::vector<JournalRow>& rows);

  /// Returns the identifiers of the drives in the order of their addition. Throws InputError if a drive or
  /// its entry is missing, or if an identifier is invalid.
  std::vector<std::string> drives() const;

  /// Compares the rows and the identifier of a drive with the stored checksum, and returns the number of the
  /// drive. Throws InputError if the drive is missing or changed.
  std::int64_t check(const std::string& drive) const;

  /// Returns the rows of a drive, in order; numbers are bit-identical to the written ones. Throws InputError
  /// in the cases of check(), and for a physically impossible number (fault()).
  std::vector<JournalRow> rows(const std::string& drive) const;

  /// Returns the number of rows of all drives.
  std::int64_t size() const;

 private:
  std::unique_ptr<JournalDatabase> database_;
};

}  // namespace talus::costmap
