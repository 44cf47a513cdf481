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

/// A cost map without one of its constraints, to determine which constraint blocks a route. A cell is called
/// closed if the rover may not enter it on any heading. The constraints remove:
///   Pitch    cells steeper than permitted on any heading, including the changes of slope at their edges
///            (StepEdges::Kind::Slope), and headings beyond the limit along the heading. Beyond this limit
///            the soil is assumed to hold up to the sum of the limit and the drawbar-pull margin there.
///   Roll     headings beyond the limit across the heading and, if the route leads across the slope
///            (slopesAcross()), also the cells of Pitch
///   Soil     headings that soil, motors or policy do not allow within both limits, where the rover does
///            not tip
///   Rim      the clearance from the edge of the map
///   Slope    Pitch, Roll and Soil together
///   Hazard   rocks, keep-out areas, impassable classes, steps, rough ground, and the clearance around them
///   Unknown  unobserved ground and the clearance around it
/// A sheer step and the tilt of the plane that is fitted over the step are removed together. The cell then
/// has the gradient of the surrounding ground (StepEdges::settled()), and remains closed if this gradient is
/// steeper than permitted on any heading. An opened cell has the ground of the nearest cell that is not
/// closed, on its own slope. Ours.
class LiftedGround {
 public:
  /// `hazards` gives the hazards of closed cells; if empty, every closed cell is attributed to Hazard.
  /// `across` is true if the blocked route leads across slopes rather than up or down (slopesAcross()).
  LiftedGround(const costmap::CostGrid& map, const HazardsOf& hazards, bool across = false);

  /// Returns the map without a constraint; null if the constraint closes no cell and excludes no heading. For
  /// Hazard only cells that the hazards `kinds` alone close, and their clearance, are opened. `also` is removed together
  /// with `constraint`, which must be Hazard, Unknown or Rim then.
  std::shared_ptr<const costmap::CostGrid> without(Constraint constraint, costmap::Hazard kinds = kSolid,
                                                   std::optional<Constraint> also = {}) const;

  /// Hazards that belong to Constraint::Hazard.
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
  // Hazards of kSolid, of the cell or of the cell that requires the clearance.
  std::vector<costmap::Hazard> solid_;
  std::vector<costmap::CellCode::Curve> ground_;  // cost-curve index of the nearest cell that is not closed
  std::optional<StepEdges> edges_;
};

/// Returns true if the ground between both ends of `line` slopes more across the line than along it.
bool slopesAcross(const costmap::CostGrid& map, const Segment& line);

}  // namespace talus::planner
