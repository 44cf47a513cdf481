#pragma once

#include <string_view>

#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/pose/hybrid_search.hpp>
#include <talus/planner/pose/pose_sampling.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Plans drives that respect the problem's kinematics, through all via points in order. Each leg is the
/// cheaper of a HybridSearch and a curve fitted to FieldPlanner's route, and starts with the heading at which
/// the previous leg ended. The search data of the last map and goal are cached. Not thread-safe: use one
/// object per thread.
class PosePlanner {
 public:
  static constexpr std::string_view kName = "hybrid";          ///< in plannerNames()
  static constexpr std::string_view kSampling = "RRTstarSE2";  ///< in plannerNames(): kName, then improved by
                                                               ///< RRT*

  explicit PosePlanner(const HybridOptions& options = {}) : search_(options) {}

  /// Enables improvement of each leg by improvedBySampling().
  void sample(const PoseSamplingSettings& settings) { sampling_ = settings; }

  /// Returns a drive, or the reason why there is none. With a goal tolerance, the drive ends at the goal or
  /// at the end of the any-angle route, whichever is cheaper. Throws std::invalid_argument if the problem has
  /// no map or the turning radius is out of range.
  Plan plan(const Problem& problem);

 private:
  PosePlan drivenTo(PoseProblem asked, const Problem& problem, maps::Point end);
  PosePlan drivenWithin(PoseProblem asked, const Problem& problem);
  PosePlan alongRoute(const PoseProblem& asked, const Problem& problem);

  std::optional<PoseSamplingSettings> sampling_;
  HybridSearch search_;
  FieldPlanner field_;
  LowerBound bound_;
};

}  // namespace talus::planner
