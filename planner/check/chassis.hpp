#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <talus/maps/grid/grid.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/route/kinematics.hpp>
#include <talus/terramech/contact/rover.hpp>

/// Checks pitch, roll and ground clearance of a rover along a motion, by lower and upper bounds.
namespace talus::planner {

/// Connection of the wheels to the body.
enum class Suspension {
  Rigid,        ///< wheels fixed to the body; the body rests on three wheels
  RockerBogie,  ///< three axles: a bogie connects front and middle, a rocker the bogie and the rear; all
                ///< wheels touch the ground
};

/// "rigid", "rocker-bogie".
std::string_view name(Suspension suspension) noexcept;

/// Closed interval.
struct Bounds {
  double low = 0.0;
  double high = 0.0;
};

/// Lower and upper bounds of pitch and roll, and lower bound of the clearance, of a rover at a pose.
struct Stance {
  Bounds pitch_rad;          ///< pitch of the body's long axis, nose up > 0
  Bounds roll_rad;           ///< roll of the body's cross axis, left side up > 0
  double clearance_m = 0.0;  ///< lower bound of the belly's height above ground; < 0: contact possible
};

/// Conservative stance of a rover over an elevation raster, interpolated bilinearly between cell centres,
/// after ACE (otsu_2019). Bounds of each wheel's height are the lowest and highest ground in the box that its
/// contact point cannot leave while the body tilts within its limits. Bounds of pitch, roll and body height
/// follow from the wheel heights; the belly is compared with the highest ground below each of its sections.
/// Wheels are evenly spaced in two rows and touch the ground at a point below their centre (the smoothing
/// effect of the wheel radius is neglected). Pitch and roll are asin(rise) of the long and cross axes. The
/// bounds are valid for tilts within the rover's limits. Immutable; safe to share between threads.
class Chassis {
 public:
  /// Throws std::invalid_argument for a rocker-bogie without three axles. Keeps a reference to the raster.
  /// The raster contains elevations [m]; NaN: unknown.
  Chassis(const maps::Raster<float>& elevation_m, const terramech::Rover& rover, Suspension suspension);

  /// Distance of the represented poses from a pose: a shift of the whole rover, and the displacement of its
  /// farthest wheel by a turn.
  struct Slack {
    double shift_m = 0.0;  ///< >= 0
    double turn_m = 0.0;   ///< >= 0
  };

  /// Returns the bounds of pitch, roll and clearance over all poses within the slack; empty if the ground
  /// under the rover is not known.
  std::optional<Stance> stance(const Pose& pose, const Slack& slack) const;
  /// Returns the bounds at the pose itself, without slack.
  std::optional<Stance> stance(const Pose& pose) const { return stance(pose, {0.0, 0.0}); }

  /// Reason why the rover may not stand at the pose; empty if allowed.
  std::string_view refusal(const Pose& pose, const Slack& slack) const;
  /// Returns the reason at the pose itself, without slack; empty if allowed.
  std::string_view refusal(const Pose& pose) const { return refusal(pose, {0.0, 0.0}); }

  /// Violations along a drive, including arcs and turns in place, and along a polyline with turns in place at
  /// its corners. The slack of the checked poses covers every pose between them.
  std::vector<Violation> violations(const PosePath& drive) const;
  std::vector<Violation> violations(const std::vector<maps::Point>& route) const;

 private:
  struct BodyPoint {
    double x_m, y_m;  // in the body frame
  };
  using Heights = std::vector<Bounds>;  // left and right alternating, front axle first
  struct Tilt {
    double pitch_rad, roll_rad;  // largest magnitudes
  };

  // Plane of height 0 at a place.
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
  std::vector<BodyPoint> p_body_wheels_;
  double reach_m_;  // of the farthest wheel
};

}  // namespace talus::planner
