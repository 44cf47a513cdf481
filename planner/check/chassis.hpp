#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <talus/maps/grid/grid.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/route/kinematics.hpp>
#include <talus/terramech/contact/rover.hpp>

/// Check of pitch, roll and ground clearance of a rover along a motion, with lower and upper bounds.
namespace talus::planner {

/// Connection of the wheels to the body.
enum class Suspension {
  Rigid,  ///< wheels fixed to the body; the body rests on three wheels
  /// Three axles: the bogie joins front and middle wheels, the rocker joins bogie and rear wheel; all wheels
  /// touch the ground.
  RockerBogie,
};

/// Returns "rigid" or "rocker-bogie".
std::string_view name(Suspension suspension) noexcept;

/// Closed interval from `low` to `high`.
struct Bounds {
  double low = 0.0;
  double high = 0.0;
};

/// Lower and upper bounds of pitch and roll, and lower bound of the ground clearance, of a rover at a pose.
struct Stance {
  Bounds pitch_rad;  ///< pitch of the longitudinal axis of the body, nose up > 0
  Bounds roll_rad;   ///< roll of the lateral axis of the body, left side up > 0
  /// Lower bound of the height of the belly above the ground; < 0: contact is possible.
  double clearance_m = 0.0;
};

/// Conservative bounds of the stance (pitch, roll and ground clearance) of a rover on an elevation raster,
/// which is interpolated bilinearly between cell centres, after ACE (otsu_2019). The bounds of the height of
/// a wheel are the lowest and highest ground in a box. The contact point of the wheel cannot leave this box
/// while the body tilts within its limits. Bounds of pitch, roll and body height follow from the wheel
/// heights; the belly is compared with the highest ground below each of its sections. Wheels are evenly
/// spaced in two rows and touch the ground at a point below their centre (the smoothing effect of the wheel
/// radius is neglected). Pitch and roll are asin(rise) of the longitudinal and lateral axes. The bounds are
/// valid for tilts within the limits of the rover. Immutable; safe to share between threads.
class Chassis {
 public:
  /// `elevation_m` contains elevations [m], NaN if unknown; the raster must outlive the object. Throws
  /// std::invalid_argument for a rocker-bogie without three axles.
  Chassis(const maps::Raster<float>& elevation_m, const terramech::Rover& rover, Suspension suspension);

  /// Deviation of a pose from the pose at which the bounds are computed. The bounds are valid for all poses
  /// within the slack, so that a finite number of poses covers a continuous motion.
  struct Slack {
    double shift_m = 0.0;  ///< largest translation of the rover, >= 0
    /// Largest displacement by rotation of the wheel farthest from the centre of the rover, >= 0.
    double turn_m = 0.0;
  };

  /// Returns the bounds of pitch, roll and clearance over all poses within `slack` of `pose`; empty if the
  /// ground under the rover is not known.
  std::optional<Stance> stance(const Pose& pose, const Slack& slack) const;
  /// Returns the bounds at `pose` without slack.
  std::optional<Stance> stance(const Pose& pose) const { return stance(pose, {0.0, 0.0}); }

  /// Returns the reason why the rover may not stand at a pose within `slack` of `pose`; empty if all poses
  /// are allowed.
  std::string_view refusal(const Pose& pose, const Slack& slack) const;
  /// Returns the reason at `pose` without slack; empty if the pose is allowed.
  std::string_view refusal(const Pose& pose) const { return refusal(pose, {0.0, 0.0}); }

  /// Returns the violations along a drive with arcs and turns in place. The slack of the checked poses covers
  /// every pose between them.
  std::vector<Violation> violations(const PosePath& drive) const;
  /// Returns the violations along a polyline, with a turn in place at each vertex.
  std::vector<Violation> violations(const std::vector<maps::Point>& route) const;

 private:
  struct BodyPoint {
    double x_m, y_m;  // in the body frame
  };
  using Heights = std::vector<Bounds>;  // left and right alternating, front axle first
  struct Tilt {
    double pitch_rad, roll_rad;  // largest magnitudes
  };

  // Plane near the ground under the rover, relative to which heights are measured.
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
  double reach_m_;  // distance from the centre of the rover to its farthest wheel
};

}  // namespace talus::planner
