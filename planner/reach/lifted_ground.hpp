#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/planner/reach/reach.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/problem.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Classification of the cells that Hazard::Step or Hazard::Roughness excludes, from the heights around them.
/// A cell is either at a sheer step, which also tilts the plane fitted to the ground, or at the edge of a
/// slope, where the change of slope exceeds the ground clearance of the rover. Ours.
///
/// For two neighbouring cells, d is the rise between them, a the rise before the first cell and b the rise
/// after the second cell. The step of the pair is |d - minmod(a, b)| (maps/terrain/step_height.hpp). The pair
/// is an edge if its step exceeds the step of every pair without an excluded cell. An edge is Sheer if d
/// exceeds a and b, in the direction of d, by more than half of the step. Otherwise the edge is of kind Slope
/// if one of the three rises is a gradient that the ground does not allow. An excluded cell has the kind of
/// the edge that is nearest in king's moves over excluded cells.
class StepEdges {
 public:
  enum class Kind : std::uint8_t { None, Sheer, Slope };

  /// Function that returns true if the rover may not drive straight up or straight down a gradient >= 0 [-]
  /// on the ground of a cell.
  using Refuses = std::function<bool(maps::Cell cell, double gradient)>;

  /// Classifies all cells. On a map without heights all cells have the kind None.
  StepEdges(const costmap::CostGrid& map, const HazardsOf& hazards, const Refuses& refuses);

  /// Returns the kind of a cell.
  Kind at(maps::Cell cell) const noexcept { return kinds_[map_.grid().index(cell)]; }

  /// Returns the code of a cell with the gradient of the ground without sheer steps: medians of the rises
  /// between neighbouring cells in the surrounding 5 x 5 cells.
  costmap::CellCode settled(maps::Cell cell) const;

 private:
  // Two neighbouring cells in a row or column, and the rises [m] before, between and after both cells.
  struct Pair {
    maps::Cell first, second;
    double before, between, after;

    double step_m() const noexcept;
    double excess_m() const noexcept;
  };

  double height_m(maps::Cell cell) const noexcept;
  std::optional<Pair> pair(maps::Cell cell, maps::Cell step) const noexcept;
  template <typename Take>
  void forEachPair(Take take) const;
  double highestAllowed_m(const HazardsOf& hazards) const;
  void spread(const HazardsOf& hazards, const std::vector<maps::Cell>& sheer,
              const std::vector<maps::Cell>& of_slopes);

  const costmap::CostGrid& map_;
  std::vector<Kind> kinds_;
};

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

/// Finds the obstruction between `places.from` (start) and `places.to` (goal): the set of cells reachable
/// from the start, the set of cells from which the goal is reachable, and the constraint that separates both
/// sets. Each constraint is tested by a computation of both sets on a map without this constraint
/// (LiftedGround), on maps of up to kTriedCells only. After a stop, or if a set is empty, start and goal are
/// returned instead of the closest cells of both sets.
Obstruction obstructionBetween(const costmap::CostGrid& map, HeadingSets& headings, Reach& from_start,
                               const Segment& places, double tolerance_m, const HazardsOf& hazards = {},
                               const StopCheck& stop = {});

/// Returns one line of text with the numbers of cells, the closest cells, and the constraint that must be
/// changed.
std::string text(const Obstruction& obstruction, const Segment& places);

/// Largest number of cells of a map for which constraints are tested.
inline constexpr std::size_t kTriedCells = 4'000'000;

}  // namespace talus::planner
