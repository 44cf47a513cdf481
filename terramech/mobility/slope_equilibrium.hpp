#pragma once

#include <memory>
#include <string>
#include <vector>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>

namespace talus::terramech {

/// Quantities of a wheel with load W and radius r that drives at constant speed.
struct SteadyWheel {
  double drawbar_pull_over_load = 0.0;   ///< DP/W [-]; the gradient that an even wheel climbs
  double sinkage_over_radius = 0.0;      ///< z/r [-]; 1: the soil cannot carry the wheel
  double torque_over_load_radius = 0.0;  ///< torque ratio T/(rW) [-]
  double side_force_over_load = 0.0;     ///< side force that resists sideways motion, over load, >= 0 [-]
};

/// Slip at which traversability is assessed (thesis 3.5) [-].
inline constexpr double kReferenceSlip = 0.5;

/// Returns the state of a wheel of a rover at the reference slip on level ground, the input of categorise(), on its
/// pass >= 1 over the track. A model acts without its sensor errors; its effects act only if their covariates are
/// known: speed, rim speed (the rover's maximum), pass and slope 0. Throws std::invalid_argument for a soil, rover
/// or pass out of range, and for the base model linear-formula, which needs a measured torque.
SteadyWheel mobilityReference(const RefinedModel& model, const Rover& rover, int pass = 1);

/// Steady motion of a rover over an inclined plane in any direction: the slip and slip angle at which the
/// wheel forces balance the weight.

struct Planar;

/// Gradient (rise over horizontal run) of an inclined plane, relative to the direction of travel [-].
struct Gradient {
  double along = 0.0;   ///< gradient along the direction of travel, uphill > 0
  double across = 0.0;  ///< gradient across the direction of travel, rising to the left > 0
};

/// Returns the demand of a plane: the tangential force that balances the weight, divided by the normal force
/// [-]. For the gradients a along and c across the direction of travel, the component x along is a sqrt(1 +
/// a^2 + c^2) / sqrt(1 + a^2), and the component y across is c / sqrt(1 + a^2).
Planar demandOf(const Gradient& gradient) noexcept;

/// Reason why a rover has no steady motion over a plane.
enum class SlopeFailure {
  None,        ///< no failure: the rover has a steady motion
  Tips,        ///< the vertical through the centre of mass passes an edge of the outermost wheels
  Sinks,       ///< a wheel sinks to its axle, or by the rover's ground clearance
  CannotPull,  ///< the drawbar pull is insufficient uphill at any slip up to kMostSlip
  Slides,      ///< the wheel forces do not hold the rover downhill or across the slope
  Torque       ///< a wheel needs a torque above max_torque_Nm
};

/// Returns "holds" (for None), "tips", "sinks", "cannot pull", "slides" or "torque".
const char* name(SlopeFailure failure);

/// Steady motion of a rover over an inclined plane, or the reason of failure. After a failure the numbers are
/// those that were computed before the failure was found. The demand is the force demand of demandOf().
struct SlopeState {
  SlopeFailure failure = SlopeFailure::None;  ///< reason of failure, or None
  /// Failure other than tip-over, computed with wheel loads limited to those at 97 % of the tip-over demand.
  SlopeFailure grip = SlopeFailure::None;
  /// RoverStance::stabilityMargin_rad() for the direction of the body on the plane.
  double stability_margin_rad = 0.0;
  double slip = 0.0;  ///< slip along the wheel planes; for skid steering the mean of left and right wheels
  /// Angle from the wheel planes to the direction of travel, positive to the left; mean of the axles.
  double slip_angle_rad = 0.0;
  /// Angle of the front wheels minus angle of the rear wheels, positive to the left; 0 for a skid-steered
  /// rover.
  double steering_rad = 0.0;
  double slip_difference = 0.0;  ///< slip of the right minus slip of the left wheels of a skid-steered rover
  /// Angle from the direction of travel to the body axis, positive to the left; 0 if all wheels are steered.
  double body_turn_rad = 0.0;
  double sinkage_m = 0.0;             ///< sinkage of the deepest wheel
  double torque_Nm = 0.0;             ///< torque of the wheel with the largest |torque|, with its sign
  double side_force_over_load = 0.0;  ///< largest |F|/N (side force over normal load) of a wheel [-]
  /// Energy of all wheels together and hotel power per metre of travel. A braking wheel supplies others that
  /// drive, and no other load (ours).
  double energy_J_per_m = 0.0;
  double speed_mps = 0.0;  ///< travel speed if the fastest rim has the maximum rim speed

  /// Returns true if the rover has a steady motion, i.e. if `failure` is None.
  bool holds() const { return failure == SlopeFailure::None; }
};

/// Motion and forces of one wheel in the steady motion of the rover.
struct WheelOnSlope {
  double load_N = 0.0;          ///< load normal to the plane
  double slip = 0.0;            ///< slip along the wheel plane, [-1, 1]
  double slip_angle_rad = 0.0;  ///< from the wheel plane to the direction of travel, positive to the left
  double sinkage_m = 0.0;
  double torque_Nm = 0.0;
  double drawbar_pull_N = 0.0;  ///< force along the wheel plane
  double side_force_N = 0.0;    ///< force across the wheel plane, positive to the left
};

/// Solver of the steady motion of one rover on one kind of ground. The wheel forces, resolved along and
/// across the direction of travel, balance the weight components and have no yaw moment about the centre of
/// mass. Wheel loads include load transfer in pitch and roll (iagnemma_dubowsky_2004, ishigami_2009:
/// quasi-static). The demand per normal force is demandOf(). The unknowns are slip and slip angle, equal for
/// all wheels, and one difference between wheels that balances the yaw moment. This difference depends on the
/// steering:
///   all wheels steer   body axis in the direction of travel, front and rear wheels have different angles;
///   ackermann          body axis and rear wheels have one angle, front wheels another angle;
///   skid               body axis and all wheels have one angle, left and right wheels have different slip.
/// If several equilibria exist, the result is the one with the least slip angle and, among those, the least
/// slip. A slip > 0 is driven, a slip < 0 braked. The wheels of later axles roll in the ruts of the front axle
/// (rutted()); if the body is turned by beta to the direction of travel, the share exp(-2 (d sin(beta) / b)^2)
/// of their width b does, d behind the front axle (ours). Ground of the strength s has s times the shear
/// stresses of the class under a wheel: torque and side force are multiplied by s, the drawbar pull is the
/// torque over the radius less the resistance of the class, and the sinkage is that of the class (ours).
/// Pitch and roll limits of the rover are not checked. Immutable, cheap to copy, thread-safe.
class SlopeEquilibrium {
 public:
  /// Prepares the solver for a soil, or for a wheel model with effects. Throws std::invalid_argument if soil or
  /// rover is outside its range.
  SlopeEquilibrium(const Soil& soil, const Rover& rover);
  SlopeEquilibrium(const RefinedModel& model, const Rover& rover);

  static constexpr double kMostSlip = 0.8;  ///< slip above which the rover is immobilised (ours) [-]
  /// Slip angle above which the rover slides: the wheel model was compared with data up to 45 deg (ours).
  static constexpr double kMostSlipAngle_rad = 0.7854;
  static constexpr double kMostStrength = 5.0;  ///< greatest result of leastStrength() [-]

  /// Returns the steady motion over a plane with this gradient on ground of the given strength >= 0, or the
  /// reason of failure.
  SlopeState at(const Gradient& gradient, double strength = 1.0) const noexcept;

  /// Returns the least strength, within 5e-4, at which slip and slip angle stay within their limits;
  /// kMostStrength if there is none below. Tipping, sinkage and torque are not considered. `near` is an
  /// estimate of the result, which saves time if it is close.
  double leastStrength(const Gradient& gradient, double near = 0.5) const noexcept;

  /// Returns the state of each wheel for a rover state without failure, from front to rear, left before
  /// right.
  std::vector<WheelOnSlope> wheels(const Gradient& gradient, const SlopeState& state,
                                   double strength = 1.0) const;

  /// Returns the state of one wheel that carries an equal share of the weight straight up the slope that its
  /// drawbar pull climbs, on fresh ground or in the rut of an equal wheel. The slip must be in [-1, 1] and the slip
  /// angle within 60 deg.
  SteadyWheel evenWheel(double slip, double slip_angle_rad, bool in_rut = false) const noexcept;

  /// Returns true if the centre of mass is on the longitudinal axis of the rover.
  bool symmetric() const noexcept;

  /// Returns a copy whose later axles roll on fresh ground, too.
  SlopeEquilibrium withoutRuts() const;

 private:
  class Solver;
  explicit SlopeEquilibrium(std::shared_ptr<const Solver> solver);
  std::shared_ptr<const Solver> solver_;
};

/// Returns the assumptions that replace missing values of a rover file, one sentence each. The result is
/// empty for a complete file.
std::vector<std::string> slopeAssumptions(const Rover& rover);

}  // namespace talus::terramech
