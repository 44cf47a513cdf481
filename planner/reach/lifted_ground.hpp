#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/reach/step_edges.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// A map without one of its constraints, to find which of them closes a way. What refuses a cell whole counts to
///   Pitch    ground steeper than any heading may stand, with the bends at its edges (StepEdges::Kind::Slope); and what the
///            limit along the heading refuses, as far as soil holds at the limit
///   Roll     what the limit across the heading refuses, and, where the way leads across the slope (slopesAcross()), the ground
///            of Pitch, too
///   Soil     what soil, motors and policy refuse within both limits, where the rover does not tip
///   Rim      the clearance kept from the map's rim
///   Slope    what Pitch, Roll and Soil refuse
///   Hazard   rocks, keep-out areas, impassable classes, steps, rough ground, and the clearance around them
///   Unknown  unobserved ground and the clearance around it
/// A sheer step and the tilt of the plane fitted over it are one: without it a cell has the gradient of the ground around
/// (StepEdges::settled()), and remains refused where that is steeper than any heading may stand.
/// Where the limit along the heading is lifted, soil is taken to hold as far as its pull exceeds the slope's demand
/// at the limit. Cells freed are ground as the nearest that is not refused whole, on their own slope. Ours.
class LiftedGround {
 public:
  /// Without hazards every cell refused whole counts to Hazard. With `across` the way that is closed leads across slopes
  /// rather than up or down (slopesAcross()).
  LiftedGround(const costmap::CostGrid& map, const HazardsOf& hazards, bool across = false);

  /// Null where the constraint refuses no cell whole and no heading. Of Hazard only cells of these kinds alone, and
  /// their clearance.
  std::shared_ptr<const costmap::CostGrid> without(Constraint constraint,
                                                   costmap::Hazard kinds = kSolid) const;
  /// Without Slope and Hazard::Step at once; null where no cell is refused whole by a step.
  std::shared_ptr<const costmap::CostGrid> withoutSlopesAndSteps() const;

  /// The hazards of Constraint::Hazard.
  static constexpr costmap::Hazard kSolid = costmap::Hazard::KeepOut | costmap::Hazard::Obstacle |
                                            costmap::Hazard::Rocks | costmap::Hazard::Step |
                                            costmap::Hazard::Roughness;

 private:
  enum class Kind : std::uint8_t { Open, Steep, Fixed, Unseen, Rim, Near };
  Kind kindOf(maps::Cell cell, const HazardsOf& hazards) const;
  bool isFreed(Constraint constraint, costmap::Hazard kinds, std::size_t cell) const noexcept;
  bool isSteep(costmap::CellCode code) const noexcept;
  bool refuses(maps::Cell cell, double gradient) const noexcept;
  costmap::Hazard solidOf(maps::Cell cell, const HazardsOf& hazards) const;
  void settleNear();
  void findGround();

  const costmap::CostGrid& map_;
  bool across_;
  std::vector<Kind> kinds_;
  std::vector<costmap::Hazard> solid_;  // of kSolid, of the cell or what it is kept clear of
  std::vector<std::uint8_t> ground_;    // number of the nearest cell that is open
  std::optional<StepEdges> edges_;
};

/// Whether the ground between two places slopes more across the line from one to the other than along it.
bool slopesAcross(const costmap::CostGrid& map, const Segment& line);

}  // namespace talus::planner
