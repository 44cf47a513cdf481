#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include <talus/common/checksum.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::costmap {

/// Computes the identifier of a drive that is received in parts: a checksum of the used columns of each row,
/// ordered by column name, as 16 hexadecimal digits. The order of a file's columns and unused columns have no
/// effect.
class DriveId {
 public:
  /// Adds the next part of the drive.
  void add(const terramech::Telemetry& telemetry);
  /// Returns the identifier of the parts so far.
  std::string text() const;

 private:
  Checksum sum_{};
};

/// Returns the number of a drive in a map (WheelObservation::drive): a checksum of the first row of the
/// drive, so that further rows of a file that grew, or of further parts, belong to the same drive. Two drives
/// with the same number, of 65 536 possible numbers, count as one drive.
std::uint16_t driveTag(const terramech::Telemetry& telemetry);

/// Number of rows in the beginning of a drive: `rows` accepted by the file's reader, and `rejected` by it.
struct DriveBeginning {
  std::size_t rows = 0, rejected = 0;
};

/// Returns the longest beginning of a telemetry whose identifier is among `drives`, i.e. the known rows of a
/// file that grew.
DriveBeginning knownBeginning(const terramech::Telemetry& telemetry,
                              const std::map<std::string, TraversabilityMap::Drive>& drives);

}  // namespace talus::costmap
