#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/map/traversability_map.hpp>

namespace talus::costmap {

/// A quantity that determines the category of a cell.
struct Cause {
  std::string name;                                       ///< "slope_rad"
  double value = 0.0;                                     ///< in the unit of the name's suffix
  double std = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation; NaN: unknown
  std::string source;                                     ///< origin of the value
  std::string remark;                                     ///< effect on the category; may be empty
};

/// Category of a cell, with the quantities that determine the category.
struct Explanation {
  terramech::Category category = terramech::Category::Unknown;
  double probability = 0.0;  ///< probability of the category; NaN for Unknown
  std::string verdict;       ///< summary in one line
  std::vector<Cause> causes;
};

/// Explains a cell inside the map for one heading; without a heading, for worstHeading().
Explanation explain(const TraversabilityMap& map, maps::Cell cell,
                    const std::optional<Direction>& heading = std::nullopt);

}  // namespace talus::costmap
