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

/// Input of the search for a drive (route of arcs and turns in place). Points are map coordinates [m].
struct PoseProblem {
  std::shared_ptr<const costmap::CostGrid> map;  ///< cost map, kept in memory during the search
  maps::Point start;
  maps::Point goal;
  std::optional<double> start_heading_rad;  ///< heading at the start; empty: any heading
  std::optional<double> goal_heading_rad;   ///< heading at the goal; empty: any heading
  Kinematics kinematics;
  double time_limit_s = std::numeric_limits<double>::infinity();  ///< time limit of the search, > 0
  ProgressMonitor watch;
  /// Limit on the number of expanded poses. The smaller of this limit and HybridOptions::most_expanded
  /// applies.
  std::uint64_t most_expanded = std::numeric_limits<std::uint64_t>::max();
};

/// Parameters of the search.
struct HybridOptions {
  int headings = 72;        ///< number of discrete headings per cell, >= 8
  double step_cells = 1.5;  ///< length of a motion in cells; a length above sqrt(2) leaves the cell
  /// Weight of the cost-to-go estimate, >= 1. With larger weights the search finds a drive earlier, but the
  /// drive is more expensive.
  double heuristic_weight = 1.1;
  /// Suboptimality bound, >= 1. When the cost of the drive is at most this multiple of the lowest estimate in
  /// the queue, the search expands `improve` more poses and ends.
  double suboptimality_bound = 1.03;
  std::uint64_t improve = 500;  ///< number of poses expanded after the suboptimality bound is reached
  /// Limit on the number of expanded poses (long motions count more), about 2 s. If no drive is known then,
  /// the result is NoneFound.
  std::uint64_t most_expanded = 150'000;
};

/// Result of the search for a drive.
struct PosePlan {
  RouteStatus status = RouteStatus::NoneFound;
  std::string reason;          ///< reason if no drive was found; empty if the status is Found
  PosePath path;               ///< the drive
  double cost_J = 0.0;         ///< exact cost of the drive by PoseCost
  std::uint64_t expanded = 0;  ///< number of expanded poses
};

/// Returns true if violations() is empty for the arcs of the drive and for the chords that are written to
/// files.
bool mayBeDriven(const costmap::CostGrid& map, const PosePath& path, const Kinematics& kinematics);

/// Hybrid A* search (dolgov_2010) over position and heading with the exact cost. Motions have constant
/// curvature and start from continuous poses; one pose is kept per cell and heading. The heuristic is the
/// anisotropic cost-to-go field of the goal, which includes slope, soil and hazards but not turning. Shortest
/// curves to the goal complete the search, and the drive is shortened wherever a direct curve is cheaper. A
/// queued motion has an approximate cost from a few cells; the exact cost is computed at expansion. If no
/// drive is found, a second search uses twice the number of headings and shorter motions. The drive has no
/// violations() (route_check.hpp), but is not optimal. The field of the latest map and goal is kept.
/// Deterministic. Not thread-safe.
class HybridSearch {
 public:
  explicit HybridSearch(const HybridOptions& options = {});

  /// Returns the drive for a problem, or a status and reason.
  PosePlan plan(const PoseProblem& problem);

 private:
  bool prepareField(const PoseProblem& problem, const StopCheck& stop);

  HybridOptions options_;
  std::shared_ptr<const EdgeLayer> edges_;
  std::optional<CostToGo> field_;
  maps::Cell field_goal_;
};

}  // namespace talus::planner
