#pragma once

#include <memory>
#include <vector>

#include <talus/cli/draw/colour.hpp>
#include <talus/costmap/map/traversability_map.hpp>
#include <talus/planner/route/heading_set.hpp>

namespace talus::cli {

/// Allowed headings of the cells of a map (planner::HeadingSets). They depend on the ground and on the steepness of a
/// cell: they are computed for steps of the steepness, and for the cells between steps that differ. Not thread-safe;
/// the map must outlive the object.
class HeadingsOfCells {
 public:
  explicit HeadingsOfCells(const costmap::TraversabilityMap& map);

  AllowedHeadings at(maps::Cell cell);

 private:
  AllowedHeadings on(costmap::CellCode::Curve curve, int steepness);
  AllowedHeadings of(costmap::CellCode code);

  const costmap::TraversabilityMap& map_;
  std::shared_ptr<const costmap::CostGrid> grid_;
  planner::HeadingSets sets_;
  std::vector<std::vector<AllowedHeadings>> known_;  // by curve and steepness; Unknown: not computed
};

}  // namespace talus::cli
