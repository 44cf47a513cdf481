#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include <talus/common/progress_monitor.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/pose_path.hpp>
#include <talus/planner/route/route.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// The input of a search for a drive.
struct PoseProblem {
  std::shared_ptr<const costmap::CostGrid> map;  ///< pinned while the search runs
  maps::Point start;
  maps::Point goal;
  std::optional<double> start_heading_rad;  ///< nothing: the rover may look any way
  std::optional<double> goal_heading_rad;   ///< nothing: it may arrive looking any way
  Kinematics kinematics;
  double time_limit_s = std::numeric_limits<double>::infinity();  ///< > 0
  ProgressMonitor watch;
  /// poses, where fewer than HybridOptions allow.
  std::uint64_t most_expanded = std::numeric_limits<std::uint64_t>::max();
};

/// Choices of the search.
struct HybridOptions {
  int headings = 72;        ///< discrete headings of a cell, >= 8
  double step_cells = 1.5;  ///< length of a motion; more than sqrt 2 leaves the cell
  /// Weight of the cost still to go, >= 1: more finds a drive sooner, and a dearer one.
  double heuristic_weight = 1.1;
  /// A drive that costs at most so many times the estimate of the most promising pose left ends the search
  /// soon, >= 1.
  double suboptimality_bound = 1.03;
  std::uint64_t improve = 500;  ///< poses tried after that
  std::uint64_t most_expanded =
      150'000;  ///< poses, longer motions counting more: some 2 s; then it ends, NoneFound
};

/// What the search answers.
struct PosePlan {
  RouteStatus status = RouteStatus::NoneFound;
  std::string reason;  ///< why there is no drive; empty when Found
  PosePath path;
  double cost_J = 0.0;         ///< exact, by PoseCost
  std::uint64_t expanded = 0;  ///< poses whose motions were tried
};

/// Whether violations() finds nothing, along the drive's arcs and along the chords that go into files.
bool mayBeDriven(const costmap::CostGrid& map, const PosePath& path, const Kinematics& kinematics);

/// Hybrid A* (dolgov_2010) over position and heading under the one cost function: motions of constant
/// curvature from continuous poses, one pose kept a cell and heading, led by the anisotropic cost-to-go field
/// of the goal, and finished by shortest curves; then shortened wherever a direct curve is cheaper. Motions
/// are priced by a few cells while they wait and held against the exact cost when their turn comes. The field
/// sees slope, soil and hazards but not turning, so that little is searched in vain. Where it finds none it
/// tries once more with twice the headings and shorter motions. Not optimal: a drivable answer, and a seed.
/// What it answers stands up to violations() of route_check.hpp. Keeps the field of the last map and goal.
/// Deterministic. One object one thread.
class HybridSearch {
 public:
  explicit HybridSearch(const HybridOptions& options = {});

  PosePlan plan(const PoseProblem& problem);

 private:
  bool prepareField(const PoseProblem& problem, const StopCheck& stop);

  HybridOptions options_;
  std::shared_ptr<const EdgeLayer> edges_;
  std::optional<CostToGo> field_;
  maps::Cell field_goal_;
};

}  // namespace talus::planner
