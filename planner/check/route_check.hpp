#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/route/route.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::planner {

/// Summary of a cost-grid cell over all headings, for planners without headings.
struct CellJudgement {
  /// Restriction of the headings on which the rover may cross the cell.
  enum class Kind : std::uint8_t {
    Unknown,     ///< the cell was not observed, and the policy of the map does not permit unknown ground
    Refused,     ///< no heading is allowed
    Restricted,  ///< some headings are allowed
    Open         ///< every heading is allowed
  };
  Kind kind = Kind::Unknown;
  /// Highest cost per metre over 64 equally spaced headings [J/m]; infinite unless `kind` is Open.
  float highest_J_per_m = std::numeric_limits<float>::infinity();
};

/// Computes the summaries of cells for the cost function of a map. The allowed headings are exact
/// (allowedHeadings()) and are kept by cell code, which contains the gradient of a cell and the index of its
/// cost curve (cost per metre on one kind of ground). Not thread-safe.
class CellJudge {
 public:
  /// Throws std::invalid_argument if the cost is null.
  explicit CellJudge(std::shared_ptr<const costmap::TravelCost> cost);
  ~CellJudge();

  /// Returns the restriction and the highest cost of a cell with the given code.
  CellJudgement of(costmap::CellCode cell);

  /// Returns the lowest cost per metre on level ground of all cost curves [J/m]; infinite if the rover may
  /// not drive on level ground.
  float level_J_per_m() const noexcept { return level_J_per_m_; }

 private:
  class Headings;
  std::shared_ptr<const costmap::TravelCost> cost_;
  std::unique_ptr<Headings> headings_;
  float level_J_per_m_;
};

struct PosePath;

/// Point on a route that violates a constraint.
struct Violation {
  maps::Point place;   ///< map coordinates [m]
  std::string reason;  ///< for example "required drawbar pull above the available drawbar pull"

  friend bool operator==(const Violation&, const Violation&) = default;
};

/// Returns the violations of a polyline, empty for a drivable route. Every cell that the polyline crosses,
/// touches at a corner or turns on is checked against every constraint of the map for the heading of the leg:
/// category, slope along and across, hazards, unknown ground, edge of the map. Start and goal are checked
/// only in the cell given by Grid::cellAt(), because the rover does not turn on other cells that these points
/// touch. Consecutive violations in one cell for the same reason are returned once. The check shares no code
/// with the planners or MotionCost: it sorts the crossings of cell sides and checks the centre of each
/// section. The check is exact, not sampled. After a stop request by `watch`, returns the violations found
/// until then.
std::vector<Violation> violations(const costmap::CostGrid& map, const std::vector<maps::Point>& route,
                                  const ProgressMonitor& watch = {});

/// Returns the violations along the chords of a drive (route with arcs), without a check of the turns between
/// chords. The turns of the drive are checked separately, and the drive may reverse between two chords.
std::vector<Violation> violationsOfChords(const costmap::CostGrid& map,
                                          const std::vector<maps::Point>& chords);

/// Returns the violations of a drive along its arcs. Crossings of cell sides are computed in closed form, and
/// every cell is checked for headings at most 0.01 rad apart, including the headings passed in a turn in
/// place. Arcs with less than the minimum turning radius `turning_radius_m`, and turns in place if this
/// radius is > 0, are also violations.
std::vector<Violation> violations(const costmap::CostGrid& map, const PosePath& drive,
                                  double turning_radius_m);

/// Point on a route at which the rover violates a constraint or may lack drawbar pull. dangers() returns
/// these points in order along the route.
struct Danger {
  maps::Point place;     ///< map coordinates [m]
  double along_m = 0.0;  ///< distance along the polyline from its start
  /// Probability that the rover cannot drive, (0, 1]; 1 for a violated constraint of the map.
  double probability = 1.0;
  std::string reason;  ///< reason of the violation, or "the soil may give less drawbar pull than required"
};

/// Run-time monitor for a path from any source. Returns violations(), and every cell whose soil provides less
/// drawbar pull than required with a probability above `quantile`, 0 < quantile < 1. The probability is
/// that of the cost function (TravelState::weak), for the weakest ground on which a wheel may stand. Cells
/// without a table of drive states (tests) are checked by violations() only. The result is empty for a
/// drivable route. Throws std::invalid_argument if the quantile is out of range or a point is not finite.
std::vector<Danger> dangers(const costmap::CostGrid& map, const std::vector<maps::Point>& route,
                            double quantile = 0.05);

/// Check of pitch, roll and ground clearance of a rover along a motion, with lower and upper bounds.

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
