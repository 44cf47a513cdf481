#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <talus/maps/grid/grid.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/route/kinematics.hpp>
#include <talus/terramech/contact/rover.hpp>

/// How a rover may stand on the ground along a motion: bounds that hold whatever its wheels find under them.
namespace talus::planner {

/// How the wheels hang on the body.
enum class Suspension {
  Rigid,        ///< wheels fixed to the body: it rests on three of them
  RockerBogie,  ///< three axles: a bogie joins front and middle, a rocker the bogie and the rear; all touch
};

/// "rigid", "rocker-bogie".
std::string_view name(Suspension suspension) noexcept;

/// Both ends included.
struct Bounds {
  double low = 0.0;
  double high = 0.0;
};

/// What holds of a rover standing at a pose.
struct Stance {
  Bounds pitch_rad;          ///< of the body's long axis, nose up > 0
  Bounds roll_rad;           ///< of its cross axis, left side up > 0
  double clearance_m = 0.0;  ///< belly above ground, at least; < 0: it may touch
};

/// Conservative stance of a rover over an elevation raster taken as bilinear between the middles of cells,
/// after ACE (otsu_2019): the heights that each wheel may find, from the least and greatest ground in the box
/// that its contact cannot leave while the body tilts within its limits; from them bounds of pitch, roll and
/// the body's height; the belly held against the highest ground that each part of it can be above. Wheels are
/// evenly spaced on two rows and touch at a point below their middle (their radius smooths what they cross,
/// which the bounds do not make use of). Pitch and roll are those of the axes, asin of their rise; they hold
/// as long as the body tilts within the rover's limits, the range they are used in. Immutable; safe to
/// share between threads.
class Chassis {
 public:
  /// Throws std::invalid_argument for a rocker-bogie without three axles. Keeps the raster by reference.
  Chassis(const maps::Raster<float>& elevation_m, const terramech::Rover& rover, Suspension suspension);

  /// How far poses may lie from one that stands for them: a shift of the whole rover, and what a turn moves
  /// its farthest wheel by.
  struct Slack {
    double shift_m = 0.0;
    double turn_m = 0.0;
  };

  /// Bounds at every pose within the slack of this one; nothing where the ground under the rover is not
  /// known.
  std::optional<Stance> stance(const Pose& pose, const Slack& slack) const;
  std::optional<Stance> stance(const Pose& pose) const { return stance(pose, {0.0, 0.0}); }

  /// Why the rover may not stand there; empty when it may.
  std::string_view refusal(const Pose& pose, const Slack& slack) const;
  std::string_view refusal(const Pose& pose) const { return refusal(pose, {0.0, 0.0}); }

  /// Violations along a drive, arcs and turns in place included, and along a polyline that turns in place at
  /// its corners. Nothing between the poses looked at is missed: each stands for its surroundings.
  std::vector<Violation> violations(const PosePath& drive) const;
  std::vector<Violation> violations(const std::vector<maps::Point>& route) const;

 private:
  struct Wheel {
    double x_m, y_m;  // of the body
  };
  using Heights = std::vector<Bounds>;  // rows left and right, front axle first, alternating
  struct Tilt {
    double pitch_rad, roll_rad;  // at most, either way
  };

  // A plane through height 0 at a place.
  struct Plane {
    maps::Point origin;
    double east, north;  // rise over run
    double at(maps::Point p) const noexcept {
      return east * (p.x_m - origin.x_m) + north * (p.y_m - origin.y_m);
    }
    double steepness() const noexcept { return (east < 0 ? -east : east) + (north < 0 ? -north : north); }
  };
  struct Place {
    Pose pose;
    Slack slack;
    Plane plane;
  };

  Plane planeUnder(const Pose& pose) const;
  std::optional<Bounds> above(const Plane& plane, maps::Point middle, double reach_m) const;
  std::optional<Heights> heights(const Place& place, const Tilt& tilt) const;
  Stance rigid(const Heights& z) const;
  Stance rockerBogie(const Heights& z) const;
  static double moves_m(double x_m, double y_m, const Tilt& tilt) noexcept;
  std::optional<double> underRigid(const Place& place, const Tilt& tilt, const Heights& z) const;
  std::optional<double> underRockerBogie(const Place& place, const Tilt& tilt, const Heights& z) const;
  template <typename Under>
  std::optional<double> clearance(const Place& place, const Tilt& tilt, Under under) const;

  const maps::Raster<float>& elevation_m_;
  terramech::Rover rover_;
  Suspension suspension_;
  std::vector<Wheel> wheels_;
  double reach_m_;  // of the farthest wheel
};

}  // namespace talus::planner
