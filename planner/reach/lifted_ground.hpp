#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// A map without one of its constraints, to tell which of them closes a way. What refuses a cell whole counts to
///   Pitch    ground steeper than any heading may stand, with the edges and roughness of the same cells; and what the limit
///            along the heading refuses, as far as soil holds at the limit
///   Roll     what the limit across the heading refuses, likewise
///   Soil     what soil, motors and policy refuse within both limits, where the rover does not tip
///   Hazard   rocks, keep-out areas, impassable classes, edges, rough ground, and the clearance around them
///   Unknown  unobserved ground and the clearance around it
/// The clearance kept from the map's rim counts to none: beyond it there is nothing to drive on. Cells freed are ground as the
/// nearest that is not refused whole, on their own slope. Ours.
class LiftedGround {
 public:
  /// Without hazards every cell refused whole counts to Hazard.
  LiftedGround(const costmap::CostGrid& map, const HazardsOf& hazards);

  /// Null where the constraint refuses no cell whole and no heading.
  std::shared_ptr<const costmap::CostGrid> without(Constraint constraint) const;

 private:
  enum class Kind : std::uint8_t { Open, Steep, Fixed, Unseen, Rim, Near };
  Kind kindOf(maps::Cell cell, const HazardsOf& hazards) const;
  static bool isFreed(Constraint constraint, Kind kind) noexcept;
  void settleNear();
  void findGround();

  const costmap::CostGrid& map_;
  std::vector<Kind> kinds_;
  std::vector<std::uint8_t> ground_;  // number of the nearest cell that is open
};

}  // namespace talus::planner
