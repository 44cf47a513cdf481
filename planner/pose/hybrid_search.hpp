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

/// Input of a search for a drive.
struct PoseProblem {
  std::shared_ptr<const costmap::CostGrid> map;  ///< kept alive during the search
  maps::Point start;
  maps::Point goal;
  std::optional<double> start_heading_rad;  ///< empty: any heading
  std::optional<double> goal_heading_rad;   ///< empty: any heading
  Kinematics kinematics;
  double time_limit_s = std::numeric_limits<double>::infinity();  ///< > 0
  ProgressMonitor watch;
  /// Limit on expanded poses in addition to HybridOptions::most_expanded; the smaller applies.
  std::uint64_t most_expanded = std::numeric_limits<std::uint64_t>::max();
};

/// Parameters of the search.
struct HybridOptions {
  int headings = 72;        ///< discrete headings per cell, >= 8
  double step_cells = 1.5;  ///< length of a motion; more than sqrt(2) leaves the cell
  /// Weight of the cost-to-go estimate, >= 1: larger weights find a drive earlier, but a costlier one.
  double heuristic_weight = 1.1;
  /// The search ends after `improve` more poses once the drive's cost is at most this multiple of the lowest
  /// estimate in the queue, >= 1.
  double suboptimality_bound = 1.03;
  std::uint64_t improve = 500;  ///< poses expanded after the bound is reached
  /// Limit on expanded poses (long motions count more), about 2 s; NoneFound if no drive is known then.
  std::uint64_t most_expanded = 150'000;
};

/// Result of a search.
struct PosePlan {
  RouteStatus status = RouteStatus::NoneFound;
  std::string reason;  ///< reason if no drive was found; empty if Found
  PosePath path;
  double cost_J = 0.0;         ///< exact, by PoseCost
  std::uint64_t expanded = 0;  ///< number of expanded poses
};

/// Returns true if violations() is empty for the drive's arcs and for the chords written to files.
bool mayBeDriven(const costmap::CostGrid& map, const PosePath& path, const Kinematics& kinematics);

/// Hybrid A* (dolgov_2010) over position and heading with the exact drive cost. Motions have constant
/// curvature and start from continuous poses; one pose is kept per cell and heading. The heuristic is the
/// anisotropic cost-to-go field of the goal, which includes slope, soil and hazards but not turning. The
/// search is completed by shortest curves to the goal, and the drive is shortened wherever a direct curve is
/// cheaper. Queued motions are priced by a few cells; the exact cost is checked at expansion. If no drive is
/// found, a second search uses twice the headings and shorter motions. The result is drivable, has no
/// violations() (route_check.hpp), but is not optimal. The field of the last map and goal is cached.
/// Deterministic. Not thread-safe.
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
