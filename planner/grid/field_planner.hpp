#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/refine/any_angle.hpp>
#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Plans by the whole cost-to-go field of the goal and any-angle refinement of the grid route under the exact
/// cost. Where the eight headings of the grid join start and goal nowhere, any heading is tried: NoRoute is a proof
/// (Reach), NoneFound is not.
///
/// Where a bound is requested and leaves room (Problem::prove), other corridors are refined as well and the cheapest
/// route is taken (otherCorridors), on maps of up to kCorridorCells, and the cheapest way in 32 headings
/// (manyHeadingsRoute) on those of up to kManyHeadingsCells. Where more than kLarge is left, the cheapest way over
/// points of cells (pointRoute) is tried, too.
///
/// What it worked out for a map and a goal is kept: another start to the same goal costs a walk down the
/// field and the refinement only. Deterministic, for any number of threads, as long as no time limit cuts the
/// work short. Not thread-safe: one object a thread; they may share a map.
class FieldPlanner {
 public:
  explicit FieldPlanner(const RefineOptions& refine = {}) : refine_(refine) {}

  /// A route through all via points in order, or why there is none. Throws std::invalid_argument without a
  /// map.
  Plan plan(const Problem& problem);

 private:
  // The route from one required place to the next.
  struct Stage {
    maps::Point from;
    maps::Point to;
    double tolerance_m;
  };

  Plan planStage(const Problem& problem, const Stage& stage, const StopCheck& stop);
  bool prepareEdges(const Problem& problem, const StopCheck& stop);
  static EdgeUnits unitsFor(const costmap::CostGrid& map);
  bool repairTo(const Problem& problem);
  bool prepareField(const MotionCost& cost, const Stage& stage);
  HeadingSets& headingsOf(const Problem& problem);
  Plan misplaced(const Problem& problem, const Stage& stage, bool from_there, bool to_there,
                 const StopCheck& stop);
  Plan beyondTheGrid(const Problem& problem, const Stage& stage, const StopCheck& stop);
  Plan finished(const Problem& problem, const Stage& stage, Polyline rough, const StopCheck& stop);
  Polyline refined(const Problem& problem, const Stage& stage, Polyline rough, const StopCheck& stop);
  void tryOtherCorridors(const Problem& problem, const Stage& stage, const StopCheck& stop, bool on_grid,
                         Plan& plan);
  std::vector<Polyline> manyHeadings(const Problem& problem, const Stage& stage, double most_J,
                                     const StopCheck& stop) const;
  Polyline roughRoute(const Problem& problem, const Segment& places, const StopCheck& stop);

  static constexpr std::size_t kCorridorCells = 4'000'000;      // larger maps are searched for one corridor
  static constexpr std::size_t kManyHeadingsCells = 1'000'000;  // larger ones in eight headings only
  static constexpr std::size_t kPointCells = 250'000;           // larger ones not over points of cells
  static constexpr double kProven = 1e-3;  // of the cost: a gap that no corridor is sought for
  static constexpr double kLarge =
      0.05;  // of the cost: from this gap on a way over points of cells is sought
  static constexpr double kSettled =
      1.05;  // of the cost: what such a way may cost before its vertices are settled

  Refiner refine_;
  LowerBound bound_;
  std::shared_ptr<EdgeLayer> edges_;
  std::optional<CostToGo> field_;
  std::shared_ptr<const costmap::CostGrid> field_map_;  // the version that the field is right for
  std::vector<FieldGoal> field_goals_;
  std::shared_ptr<const costmap::CostGrid> headings_map_;  // what headings_ are of
  std::unique_ptr<HeadingSets> headings_;
  maps::Point field_goal_;
  double field_tolerance_m_ = 0.0;
};

}  // namespace talus::planner
