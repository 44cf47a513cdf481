#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/problem.hpp>
#include <talus/planner/route/route.hpp>
#include <talus/planner/route/stop_check.hpp>

namespace talus::planner {

/// Table of the lowest cost found at every cell and discrete heading. The headings of a cell are contiguous
/// in memory (a block), because a search reads neighbouring headings. A cell that was not reached needs four
/// bytes.
class PoseTable {
 public:
  PoseTable(std::size_t cells, std::size_t headings) : block_(cells, 0), headings_(headings) {
    costs_.resize(headings);  // block 0 belongs to no cell
  }

  /// Returns the cost at a cell index and heading index; infinite until set. The reference is valid until the
  /// next call.
  float& at(std::size_t cell, std::size_t heading) {
    std::uint32_t& block = block_[cell];
    if (block == 0) {
      block = static_cast<std::uint32_t>(costs_.size() / headings_);
      costs_.resize(costs_.size() + headings_, std::numeric_limits<float>::infinity());
    }
    return costs_[block * headings_ + heading];
  }

 private:
  std::vector<std::uint32_t> block_;  // index of the block of each cell; 0: no block
  std::size_t headings_;
  std::vector<float> costs_;
};

/// Motions that a search tries from every pose, computed once per heading: straight, arcs with the curvatures
/// 1 / r and 1 / (3 r), where r is the turning radius, the same motions in reverse if permitted, and turns in
/// place if r = 0. The discrete headings are `offset_rad` + k 2 pi / headings; every motion ends at one of
/// them.
class MotionSet {
 public:
  struct Options {
    int headings = 72;        ///< number of discrete headings
    double step_cells = 1.5;  ///< length of a motion in cells
    double offset_rad = 0.0;  ///< heading with index 0
  };

  /// Section of a motion. Its cost is that of the cell at its centre.
  struct Stretch {
    double dx_m, dy_m;  ///< position of the centre relative to the pose
    double length_m;    ///< length of the section
    HeadingCost cost;   ///< cost per metre for the heading of the section
  };

  /// Motion that begins at one discrete heading.
  struct Motion {
    PosePath::Leg leg;
    double dx_m = 0.0, dy_m = 0.0;  ///< position of the end relative to the pose
    int heading = 0;                ///< index of the heading at the end
    int direction = 0;              ///< +1 forward, -1 in reverse, 0 turn in place
    double turn_rad = 0.0;          ///< sum of the magnitudes of all changes of heading, >= 0
    std::vector<Stretch> stretches{};
  };

  MotionSet(const costmap::CostGrid& map, const Kinematics& kinematics, const Options& options);

  /// Returns the motions that begin at the heading with an index.
  const std::vector<Motion>& from(int heading) const noexcept {
    return motions_[static_cast<std::size_t>(heading)];
  }

  double heading_rad(int heading) const noexcept { return options_.offset_rad + heading * bin_rad_; }
  int headings() const noexcept { return options_.headings; }

  /// Returns the relative computing effort of all motions from one heading: 1 for small turning radii, more
  /// for longer motions.
  std::uint64_t work() const noexcept;

  /// Returns the approximate cost [J] of a motion from a point, with the costs of the cells at the centres of
  /// its sections. Infinite if a section is not allowed or leaves the map.
  double quickCost(const Motion& motion, maps::Point from) const noexcept;

 private:
  Motion made(const PosePath::Leg& leg, int heading, int turned) const;
  std::vector<PosePath::Leg> legs() const;

  const costmap::CostGrid& map_;
  Kinematics kinematics_;
  Options options_;
  double bin_rad_;
  double inverse_resolution_;
  std::vector<std::vector<Motion>> motions_;
};

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
