#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/map/traversability_map.hpp>

namespace talus::costmap {

/// A quantity on which the category of a cell depends.
struct Cause {
  std::string name;    ///< name with the unit as suffix, e.g. "slope_rad"
  double value = 0.0;  ///< value of the quantity, in the unit of the suffix of `name`
  double std = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation of `value`; NaN: unknown
  std::string source;  ///< origin of `value`, e.g. the elevation map or the prior
  std::string remark;  ///< effect of the quantity on the category; may be empty
};

/// The category of a cell (safe, marginal, dangerous or unknown), with the quantities that determine the
/// category.
struct Explanation {
  terramech::Category category = terramech::Category::Unknown;
  double probability = 0.0;  ///< probability of `category`, 0 to 1; NaN for Unknown
  std::string verdict;       ///< summary in one line
  std::vector<Cause> causes;
};

/// Returns the category of a cell for driving in one heading, with its causes. `cell` must lie inside the
/// map. Without `heading`, the heading of worstHeading() is used.
Explanation explain(const TraversabilityMap& map, maps::Cell cell,
                    const std::optional<Direction>& heading = std::nullopt);

/// The place where one drive is expected to tell most about the ground around another place.
struct NextDrive {
  maps::Cell cell;
  Direction heading;              ///< heading in which a reading is most accurate
  std::size_t cells = 0;          ///< number of blocks of ground around that are refused or uncertain
  double std = 0.0, after = 0.0;  ///< their mean standard deviation of DP/W, before and after a reading [-]
};

/// Returns the allowed place within three correlation lengths of `around` at which a reading is expected to reduce
/// most the variance of ground that is not safe in every heading; nullopt without such ground or such places.
/// With the standard deviations s of the estimates, the variance c^2 of the class mean, that of places p^2, and the
/// error e of a reading (B4), a reading at a is expected to reduce the variance at x by
///   cov^2/(s_a^2 + e^2),  cov = min(c^2 + p^2 k(d), s_a s_x)                                      (ours)
/// Whether the rover can reach the place is not checked.
std::optional<NextDrive> nextDrive(const TraversabilityMap& map, maps::Cell around);

}  // namespace talus::costmap
