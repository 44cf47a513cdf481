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

/// A map without one of its constraints, to determine which constraint blocks a route. Completely refused
/// cells are assigned to
///   Pitch    ground steeper than permitted in any heading, including the bends at its edges (StepEdges::Kind::Slope),
///            and headings refused by the limit along the heading, as far as the soil holds at the limit
///   Roll     headings refused by the limit across the heading and, if the route leads across the slope
///            (slopesAcross()), also the ground of Pitch
///   Soil     refused by soil, motors and policy within both limits, where the rover does not tip
///   Rim      the clearance from the rim of the map
///   Slope    refused by Pitch, Roll or Soil
///   Hazard   rocks, keep-out areas, impassable classes, steps, rough ground, and the clearance around them
///   Unknown  unobserved ground and the clearance around it
/// A sheer step and the tilt of the plane fitted over the step are one constraint: without it a cell has the
/// gradient of the surrounding ground (StepEdges::settled()), and remains refused if that gradient is steeper
/// than permitted in any heading. Without the limit along the heading, the soil is assumed to hold as far as
/// its pull exceeds the slope's demand at the limit. Freed cells have the ground of the nearest cell that is
/// not completely refused, on their own slope. Ours.
class LiftedGround {
 public:
  /// Without `hazards` every completely refused cell is assigned to Hazard. `across`: the blocked route leads
  /// across slopes rather than up or down (slopesAcross()).
  LiftedGround(const costmap::CostGrid& map, const HazardsOf& hazards, bool across = false);

  /// Map without the constraint; null if the constraint refuses no cell and no heading. For Hazard only cells
  /// of the given kinds, and their clearance, are freed.
  std::shared_ptr<const costmap::CostGrid> without(Constraint constraint,
                                                   costmap::Hazard kinds = kSolid) const;
  /// Map without Slope and Hazard::Step; null if no cell is refused because of a step.
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
  std::vector<costmap::Hazard> solid_;  // hazards of kSolid, of the cell or of the cell that requires the
                                        // clearance
  std::vector<std::uint8_t> ground_;    // index of the nearest open cell
  std::optional<StepEdges> edges_;
};

/// Returns true if the ground between two places slopes more across the connecting line than along it.
bool slopesAcross(const costmap::CostGrid& map, const Segment& line);

}  // namespace talus::planner
