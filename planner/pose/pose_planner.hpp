#pragma once

#include <string_view>

#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/pose/hybrid_search.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Planner of drives (routes of arcs and turns in place) that satisfy Problem::kinematics, through all via
/// points in order. Each leg is the cheaper of the drive of a HybridSearch and a curve fitted to the route of
/// FieldPlanner. A leg starts with the heading at which the previous leg ended. Search data of the latest map
/// and goal are kept. Not thread-safe: use one object per thread.
class PosePlanner {
 public:
  static constexpr std::string_view kName = "hybrid";  ///< name in plannerNames()

  /// Returns a drive, or a plan with the reason why there is no drive. With a goal tolerance, the drive ends
  /// at the goal or at the end of the any-angle route of FieldPlanner, whichever is cheaper. Throws
  /// std::invalid_argument if the problem has no map or the turning radius is out of range.
  Plan plan(const Problem& problem);

 private:
  PosePlan drivenTo(PoseProblem asked, const Problem& problem, maps::Point end);
  PosePlan drivenWithin(PoseProblem asked, const Problem& problem);
  PosePlan alongRoute(const PoseProblem& asked, const Problem& problem);

  HybridSearch search_;
  FieldPlanner field_;
  LowerBound bound_;
};

}  // namespace talus::planner
