#pragma once

#include <cstdint>
#include <vector>

#include <talus/planner/route/heading_cost.hpp>
#include <talus/planner/route/pose_path.hpp>

namespace talus::planner {

/// The motions that a search tries from every pose, worked out once for each heading: arcs at two curvatures,
/// straight, all of it in reverse where allowed, turns in place for a rover that can. Headings are
/// `offset_rad` + k 2 pi / headings; every motion ends in one of them.
class MotionSet {
 public:
  struct Options {
    int headings = 72;
    double step_cells = 1.5;  ///< length of a motion
    double offset_rad = 0.0;  ///< heading number 0
  };

  /// A stretch of a motion, priced by the cell in its middle.
  struct Stretch {
    double dx_m, dy_m;  ///< its middle from the pose
    double length_m;
    HeadingCost cost;
  };

  /// A motion from one heading.
  struct Motion {
    PosePath::Leg leg;
    double dx_m = 0.0, dy_m = 0.0;  ///< its end from the pose
    int heading = 0;                ///< number of the heading at its end
    int direction = 0;              ///< +1, -1; 0 in place
    double turn_rad = 0.0;          ///< all changes of heading, >= 0
    std::vector<Stretch> stretches{};
  };

  MotionSet(const costmap::CostGrid& map, const Kinematics& kinematics, const Options& options);

  const std::vector<Motion>& from(int heading) const noexcept {
    return motions_[static_cast<std::size_t>(heading)];
  }

  double heading_rad(int heading) const noexcept { return options_.offset_rad + heading * bin_rad_; }
  int headings() const noexcept { return options_.headings; }

  /// What it takes to follow all motions from one heading: 1 for those of a small turning radius, more as they get longer.
  std::uint64_t work() const noexcept;

  /// Joules of a motion from a place, by its stretches' middles: quick, not exact. Infinite where one is not
  /// allowed or the motion leaves the map.
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
