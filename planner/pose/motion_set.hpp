#pragma once

#include <cstdint>
#include <vector>

#include <talus/planner/route/heading_cost.hpp>
#include <talus/planner/route/pose_path.hpp>

namespace talus::planner {

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

}  // namespace talus::planner
