#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/planner.hpp>
#include <talus/planner/refine/any_angle.hpp>
#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Planner that computes the complete cost-to-go field of the goal (minimum cost from every cell) and refines
/// the grid route to a polyline with arbitrary headings under the exact cost. If the eight headings of the
/// grid do not connect start and goal, the planner tries arbitrary headings. The status NoRoute is then
/// proven (Reach); the status NoneFound is no proof.
///
/// If Problem::prove is set and the cost differs from the lower bound, the cheapest route over points of cells
/// (pointRoute) in the region of the lower bound is refined as well, and the cheaper route is returned.
///
/// Intermediate results for a map and a goal are kept: for another start to the same goal, only the path
/// along the field and the refinement are computed. Deterministic for any number of threads, unless a time
/// limit ends the search. Not thread-safe: use one object per thread; the objects may share a map.
class FieldPlanner {
 public:
  explicit FieldPlanner(const RefineOptions& refine = {}) : refine_(refine) {}

  /// Returns a route through all via points in order, or a plan with the reason why there is no route. Throws
  /// std::invalid_argument if the problem has no map.
  Plan plan(const Problem& problem);

 private:
  // Section of the route between two stops (start, via points, goal).
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
  void tryOverPoints(const Problem& problem, const Stage& stage, const StopCheck& stop, Plan& plan);
  Polyline overPoints(const Problem& problem, const Stage& stage, double most_J, const StopCheck& stop,
                      bool more = false) const;

  static constexpr double kProven = 1e-3;  // smallest relative gap for which points of cells are searched
  // Cost limit of the search over points of cells, as a multiple of the cost of the best route. It exceeds 1
  // because the vertices found by the search are not yet moved to their best positions.
  static constexpr double kSettled = 1.05;

  Refiner refine_;
  LowerBound bound_;
  std::shared_ptr<EdgeLayer> edges_;
  std::optional<CostToGo> field_;
  std::vector<FieldGoal> field_goals_;
  std::shared_ptr<const costmap::CostGrid> headings_map_;  // map version of headings_
  std::unique_ptr<HeadingSets> headings_;
  maps::Point field_goal_;
  double field_tolerance_m_ = 0.0;
};

/// Plans a route on a map that does not fit in memory. The route over the overview is the guide of each leg.
/// The leg is planned in parts along the guide, each by FieldPlanner on the cells near the part, and once more
/// across the joints of the parts. The route may differ from that of FieldPlanner on the whole map if the guide
/// does not follow the best corridor; the lower bound is that of the straight line. The status NoneFound is no
/// proof. Deterministic for any number of threads. Replaces problem.map by the map of the last leg.
Plan planInWindows(Problem& problem, WindowedMap& map);

}  // namespace talus::planner
