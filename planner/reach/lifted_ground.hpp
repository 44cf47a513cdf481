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
///   Rim      the clearance kept from the map's rim
///   Slope    what Pitch, Roll and Soil refuse
///   Hazard   rocks, keep-out areas, impassable classes, edges, rough ground, and the clearance around them
///   Unknown  unobserved ground and the clearance around it
/// Where the limit along the heading is lifted, soil is taken to hold as far as its pull exceeds the slope's demand
/// at the limit. Cells freed are ground as the nearest that is not refused whole, on their own slope. Ours.
class LiftedGround {
 public:
  /// Without hazards every cell refused whole counts to Hazard.
  LiftedGround(const costmap::CostGrid& map, const HazardsOf& hazards);

  /// Null where the constraint refuses no cell whole and no heading. Of Hazard only cells of these kinds alone, and
  /// their clearance.
  std::shared_ptr<const costmap::CostGrid> without(Constraint constraint,
                                                   costmap::Hazard kinds = kSolid) const;

  /// The hazards of Constraint::Hazard.
  static constexpr costmap::Hazard kSolid = costmap::Hazard::KeepOut | costmap::Hazard::Obstacle |
                                            costmap::Hazard::Rocks | costmap::Hazard::Step |
                                            costmap::Hazard::Roughness;

 private:
  enum class Kind : std::uint8_t { Open, Steep, Fixed, Unseen, Rim, Near };
  Kind kindOf(maps::Cell cell, const HazardsOf& hazards) const;
  bool isFreed(Constraint constraint, costmap::Hazard kinds, std::size_t cell) const noexcept;
  void settleNear();
  void findGround();

  const costmap::CostGrid& map_;
  std::vector<Kind> kinds_;
  std::vector<costmap::Hazard> solid_;  // of kSolid, of the cell or what it is kept clear of
  std::vector<std::uint8_t> ground_;    // number of the nearest cell that is open
};

}  // namespace talus::planner
