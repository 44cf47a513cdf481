#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <talus/planner/bound/admissible_edges.hpp>
#include <talus/planner/bound/straight_bound.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Computes a lower bound of the cost of every route to a goal, of any shape and heading, in levels. Each level
/// is a cost-to-go field over admissibleEdges(), and none lowers the bound.
///
/// Level 1 fits the octagons of all cells alike (FittedOctagons). With F, the field of the start, and B, the
/// field of the goal, every route of at most a cost L stays in the region of the cells with a corner at which
/// F + B <= L: it crosses the boundary of each cell where the interpolated sum is at most L (ours; compare
/// Clawson, Chacon and Vladimirsky 2014 [clawson_2014]). Level 2 consists of rounds within the region of the known
/// cost. Each fits the octagons of a limited number of cells, those of the region of the highest possible L, to
/// the differences of F between their corners, and computes F anew; B follows every second time. The field
/// satisfies its own differences, so that fits never lower it. Level 3 is a SubSolution in the region of the
/// highest L that has a limited number of cells; it proves at most L, and cells are added while it proves L. The
/// work of each level is limited. straightBoundOver_J(), or the bound on a uniform map that is nowhere more
/// expensive, is used if it is higher.
class LowerBound {
 public:
  /// Returns the lower bound [J] for routes from `places.from` to within `goal_tolerance_m` of `places.to`.
  /// `known_J` is the cost of a known route; the result is between 0 and known_J. If the relative difference
  /// of a bound from known_J is at most `gap` or kEven, no further level is computed. A level that a stop ended
  /// contributes 0. `gap` 0: levels 2 and 3 end at kEnough.
  double operator()(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                    double goal_tolerance_m, const StopCheck& stop = {},
                    double known_J = std::numeric_limits<double>::infinity(), double gap = 0.0);

  /// Computes level 1 of toGoal_J(). Returns false after a stop or if there is no bound.
  bool prepare(const std::shared_ptr<const costmap::CostGrid>& map, maps::Point goal, double goal_tolerance_m,
               const StopCheck& stop);

  /// Returns the cells, by index, outside of which no route of at most `most_J` [J] leads; empty after a stop or if
  /// there is no bound.
  std::vector<bool> corridor(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places,
                             double goal_tolerance_m, double most_J, const StopCheck& stop = {});

  /// Returns the best lower bound [J] of the cost from a place to the goal of the latest call, bilinear in each
  /// cell and therefore proven on cell sides only; 0 if there is none, infinite where no route leads.
  double toGoal_J(maps::Point place) const noexcept;

  /// Relative difference to the cost of the known route up to which a bound suffices.
  static constexpr double kEven = 1e-4;
  /// Relative difference up to which levels 2 and 3 suffice without a stated gap.
  static constexpr double kEnough = 0.02;

 private:
  OctagonOf octagonOf();
  double throughCell_J(maps::Cell cell) const;
  template <typename Each>
  void forEachInside(Each each) const;
  double costFor(std::size_t cells, double least_J, double known_J) const;
  double narrowed_J(const Segment& places, const std::vector<FieldGoal>& starts, double known_J,
                    double enough_J, const StopCheck& stop);

  std::shared_ptr<const costmap::CostGrid> map_;
  std::optional<FittedOctagons> octagons_;
  std::vector<float> level_1_;               // field of the goal, level 1
  std::vector<float> from_start_, to_goal_;  // best fields
  std::vector<bool> inside_;                 // cells on routes of at most the known cost
  maps::Point goal_;
  double tolerance_m_ = 0.0;
};

}  // namespace talus::planner
