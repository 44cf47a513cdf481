#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <talus/costmap/evidence/wheel_observation.hpp>
#include <talus/costmap/journal/journal_database.hpp>

/// Rows of a journal's tables `evidence` and `drive`.
namespace talus::costmap {

/// The bytes of a column, as text.
std::string journalText(sqlite3_stmt* row, int column);

/// Appends rows of the drive of that number.
void insertRows(const JournalDatabase& database, std::int64_t drive, const std::vector<JournalRow>& rows);

/// The rows of a drive in order.
std::vector<JournalRow> selectRows(const JournalDatabase& database, std::int64_t drive);

/// An id before that of every row, of changed journals, too.
constexpr std::int64_t kBeforeAllRows = std::numeric_limits<std::int64_t>::min();

/// What a drive's rows sum up to, each with those before it; `before`: what the rows up to id `after` do, 0 for none.
std::uint64_t rowsChecksum(const JournalDatabase& database, std::int64_t drive, std::uint64_t before,
                           std::int64_t after);

/// A drive's entry in table `drive`. What is stored there as its checksum is that of its rows, changed by its number and id,
/// so that neither can be another's.
struct DriveEntry {
  std::int64_t number = 0;
  std::string id;
  std::uint64_t checksum = 0;  ///< of its rows
};

/// The checksum as it is stored, and back: both are one function.
std::uint64_t sealed(const DriveEntry& entry);

/// Whether it is 16 hexadecimal digits, as driveId() gives, or "source NAME", as the rows of Talus 0.1.0 have.
bool isDriveId(const std::string& id);

}  // namespace talus::costmap
