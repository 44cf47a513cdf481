#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>

#include <talus/common/checksum.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

namespace talus::costmap {

/// The id of a drive of which rows come part by part: a checksum of what is used of each row, column by column in the order
/// of their names, as 16 hexadecimal digits. The order of a file's columns and columns that no map learns from do not show.
class DriveId {
 public:
  void add(const terramech::Telemetry& telemetry);
  std::string text() const;

 private:
  Checksum sum_{};
};

/// What tells drives apart in a map, WheelObservation::drive: of the first row, so that what follows, in a file that grew or in
/// parts, is of the same drive. Two of some 65 000 drives may share one: they then count as one.
std::uint16_t driveTag(const terramech::Telemetry& telemetry);

/// Rows of a drive from its beginning on: those that its file's reader left in, and those that it left out.
struct DriveBeginning {
  std::size_t rows = 0, rejected = 0;
};

/// The longest beginning, all rows at most, whose id is among `drives`: what is known of a file that grew since.
DriveBeginning knownBeginning(const terramech::Telemetry& telemetry, const std::set<std::string>& drives);

}  // namespace talus::costmap
