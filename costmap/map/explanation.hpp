#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/map/traversability_map.hpp>

namespace talus::costmap {

/// One number behind a cell's category.
struct Cause {
  std::string name;                                       ///< "slope_rad"
  double value = 0.0;                                     ///< in the unit that the name ends with
  double std = std::numeric_limits<double>::quiet_NaN();  ///< its standard deviation; NaN: not known
  std::string source;                                     ///< where it comes from
  std::string remark;                                     ///< what it does to the category; may be empty
};

/// Why a cell is what it is.
struct Explanation {
  terramech::Category category = terramech::Category::Unknown;
  double probability = 0.0;  ///< of that category; NaN where it is Unknown, which has none
  std::string verdict;       ///< one line
  std::vector<Cause> causes;
};

/// Explains a cell inside the map, for one heading or, without one, for the worst: straight up its slope, or across.
Explanation explain(const TraversabilityMap& map, maps::Cell cell,
                    const std::optional<Direction>& heading = std::nullopt);

}  // namespace talus::costmap
