#pragma once

#include <cstdint>
#include <vector>

#include <talus/planner/route/heading_cost.hpp>
#include <talus/planner/route/pose_path.hpp>

namespace talus::planner {

/// Motions tried from every pose, computed once per heading: straight, arcs at two curvatures (1 / r and 1 /
/// (3 r), r the turning radius), the same in reverse if allowed, and turns in place if r = 0. Headings are
/// `offset_rad` + k 2 pi / headings; every motion ends at one of these headings.
class MotionSet {
 public:
  struct Options {
    int headings = 72;
    double step_cells = 1.5;  ///< length of a motion
    double offset_rad = 0.0;  ///< heading of index 0
  };

  /// Stretch of a motion, priced by the cell at its centre.
  struct Stretch {
    double dx_m, dy_m;  ///< centre relative to the pose
    double length_m;
    HeadingCost cost;
  };

  /// Motion from one heading.
  struct Motion {
    PosePath::Leg leg;
    double dx_m = 0.0, dy_m = 0.0;  ///< end relative to the pose
    int heading = 0;                ///< index of the heading at the end
    int direction = 0;              ///< +1 forward, -1 reverse, 0 in place
    double turn_rad = 0.0;          ///< sum of all changes of heading, >= 0
    std::vector<Stretch> stretches{};
  };

  MotionSet(const costmap::CostGrid& map, const Kinematics& kinematics, const Options& options);

  const std::vector<Motion>& from(int heading) const noexcept {
    return motions_[static_cast<std::size_t>(heading)];
  }

  double heading_rad(int heading) const noexcept { return options_.offset_rad + heading * bin_rad_; }
  int headings() const noexcept { return options_.headings; }

  /// Relative effort of all motions from one heading: 1 for small turning radii, larger for longer motions.
  std::uint64_t work() const noexcept;

  /// Approximate cost [J] of a motion from a place, from the cells at its stretches' centres. Infinite if a
  /// stretch is not allowed or leaves the map.
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

}  // namespace talus::planner
