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

}  // namespace talus::costmap
