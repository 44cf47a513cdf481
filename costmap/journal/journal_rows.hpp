#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <talus/costmap/evidence/wheel_observation.hpp>
#include <talus/costmap/journal/journal_database.hpp>

/// Functions that read and write the rows of the tables `evidence` and `drive` of a journal.
namespace talus::costmap {

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
