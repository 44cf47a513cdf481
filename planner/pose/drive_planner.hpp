#pragma once

#include <string_view>

#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/pose/hybrid_search.hpp>
#include <talus/planner/pose/pose_sampling.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

/// Drives that keep the problem's kinematics, through all via points in order: HybridSearch leg by leg, each
/// setting out as the one before arrived, or a curve fitted to FieldPlanner's route where that is cheaper or
/// the search finds none.
/// Keeps what the search knows of map and goal. Not thread-safe: one object a thread.
class DrivePlanner {
 public:
  static constexpr std::string_view kName = "hybrid";          ///< among plannerNames()
  static constexpr std::string_view kSampling = "RRTstarSE2";  ///< the same, then improved by RRT*

  explicit DrivePlanner(const HybridOptions& options = {}) : search_(options) {}

  /// Each leg is handed to improvedBySampling() too.
  void sample(const PoseSamplingSettings& settings) { sampling_ = settings; }

  /// A drive, or why there is none. Within a goal tolerance it ends at the goal or where the any-angle route
  /// does, whichever drive costs less. Throws std::invalid_argument without a map.
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
