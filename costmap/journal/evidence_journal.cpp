#include <optional>
#include <stdexcept>

#include <sqlite3.h>

#include <talus/common/common.hpp>
#include <talus/costmap/evidence/observation_fault.hpp>
#include <talus/costmap/journal/evidence_journal.hpp>
#include <talus/costmap/journal/journal_database.hpp>

namespace talus::costmap {
namespace {

// Returns the entry of a drive; number 0 if the journal does not contain the id.
DriveEntry find(const JournalDatabase& database, const std::string& id) {
  const auto entry = database.prepare("SELECT number, checksum FROM drive WHERE id = ?");
  sqlite3_bind_text(entry.get(), 1, id.c_str(), static_cast<int>(id.size()), SQLITE_TRANSIENT);
  DriveEntry drive{.number = 0, .id = id};
  if (!database.step(entry)) return drive;
  if (sqlite3_column_type(entry.get(), 1) != SQLITE_INTEGER)
    database.refuse("drive " + id + " has no checksum: the journal was changed");
  drive.number = sqlite3_column_int64(entry.get(), 0);
  drive.checksum = static_cast<std::uint64_t>(sqlite3_column_int64(entry.get(), 1));
  drive.checksum = sealed(drive);
  return drive;
}

// Appends rows to a drive and updates its id and checksum.
void write(const JournalDatabase& database, DriveEntry entry, const std::string& id,
           const std::vector<JournalRow>& rows) {
  const std::int64_t before = database.single("SELECT ifnull(max(id), 0) FROM evidence");
  insertRows(database, entry.number, rows);
  entry.checksum = rowsChecksum(database, entry.number, entry.checksum, before);
  entry.id = id;
  const auto close = database.prepare("UPDATE drive SET id = ?, checksum = ? WHERE number = ?");
  sqlite3_bind_text(close.get(), 1, id.c_str(), static_cast<int>(id.size()), SQLITE_TRANSIENT);
  sqlite3_bind_int64(close.get(), 2, static_cast<std::int64_t>(sealed(entry)));
  sqlite3_bind_int64(close.get(), 3, entry.number);
  database.step(close);
}

void requireId(const std::string& id) {
  if (!isDriveId(id))
    throw std::invalid_argument("evidence journal: drive = '" + id + "', must be 16 hexadecimal digits");
}

}  // namespace

EvidenceJournal::EvidenceJournal(const std::string& path)
    : database_(std::make_unique<JournalDatabase>(path)) {
  beginJournal(*database_);
  // The lock prevents two processes from both creating the tables.
  Transaction transaction(*this);
  bringUpToDate(*database_);
  transaction.commit();
}

EvidenceJournal::~EvidenceJournal() = default;

EvidenceJournal::Transaction::Transaction(EvidenceJournal& journal) : journal_(&journal) {
  journal.database_->run("BEGIN IMMEDIATE");
}

EvidenceJournal::Transaction::~Transaction() {
  if (journal_) journal_->database_->rollBack();
}

void EvidenceJournal::Transaction::commit() {
  journal_->database_->run("COMMIT");
  journal_ = nullptr;
}

void EvidenceJournal::append(const std::string& drive, const std::vector<JournalRow>& rows,
                             const std::string& continued) {
  requireId(drive);
  std::optional<Transaction> own;
  if (!database_->inTransaction()) own.emplace(*this);
  if (find(*database_, drive).number != 0) return;
  DriveEntry entry = find(*database_, continued);
  if (entry.number == 0) {
    database_->run("INSERT INTO drive(id) VALUES('')");
    entry.number = database_->lastRow();
  }
  write(*database_, entry, drive, rows);
  if (own) own->commit();
}

void EvidenceJournal::replace(const std::string& drive, const std::vector<JournalRow>& rows) {
  std::optional<Transaction> own;
  if (!database_->inTransaction()) own.emplace(*this);
  DriveEntry entry = find(*database_, drive);
  if (entry.number == 0) return;
  const auto taken = database_->prepare("DELETE FROM evidence WHERE drive = ?");
  sqlite3_bind_int64(taken.get(), 1, entry.number);
  database_->step(taken);
  entry.checksum = 0;
  write(*database_, entry, drive, rows);
  if (own) own->commit();
}

std::vector<std::string> EvidenceJournal::drives() const {
  if (database_->single(
          "SELECT count(*) FROM evidence WHERE drive IS NULL OR drive NOT IN (SELECT number FROM "
          "drive)") != 0)
    database_->refuse("holds rows of a drive that is not listed: the journal was changed");
  const auto rows = database_->prepare("SELECT number, id FROM drive ORDER BY number");
  std::vector<std::string> ids;
  while (database_->step(rows)) {
    // Numbers count from 1, and no drive is ever removed.
    const std::int64_t number = sqlite3_column_int64(rows.get(), 0);
    if (number != static_cast<std::int64_t>(ids.size()) + 1)
      database_->refuse("drives are missing in it: the journal was changed");
    ids.push_back(journalText(rows.get(), 1));
    if (!isDriveId(ids.back()))
      database_->refuse("the id of drive " + std::to_string(number) + " is none: the journal was changed");
  }
  return ids;
}

std::int64_t EvidenceJournal::check(const std::string& drive) const {
  const DriveEntry entry = find(*database_, drive);
  if (entry.number == 0) database_->refuse("drive " + drive + " is not in it");
  if (rowsChecksum(*database_, entry.number, 0, kBeforeAllRows) != entry.checksum)
    throw InputError({database_->path() + ", drive " + drive,
                      "its rows or its id were changed since they were written: checksum mismatch",
                      "restore the journal from a copy"});
  return entry.number;
}

std::vector<JournalRow> EvidenceJournal::rows(const std::string& drive) const {
  std::vector<JournalRow> rows = selectRows(*database_, check(drive));
  for (const JournalRow& row : rows) {
    const std::string reason = row.accepted ? fault(row.observation) : "";
    if (!reason.empty())
      throw InputError({database_->path() + ", drive " + drive,
                        "row of line " + std::to_string(row.line) + ": " + reason,
                        "restore the journal from a copy"});
  }
  return rows;
}

std::int64_t EvidenceJournal::size() const {
  return database_->single("SELECT count(*) FROM evidence");
}

}  // namespace talus::costmap
