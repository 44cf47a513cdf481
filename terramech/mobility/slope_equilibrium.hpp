#pragma once

#include <memory>
#include <string>
#include <vector>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>

/// Steady motion of a rover over an inclined plane in any direction: slip and slip angle at equilibrium.
namespace talus::terramech {

struct Planar;
struct RefinedModel;

/// Gradient of the plane relative to the direction of travel: rise over horizontal run [-].
struct Gradient {
  double along = 0.0;   ///< uphill > 0
  double across = 0.0;  ///< rising to the left > 0
};

/// Returns the force demand per normal force [-], along and across: a sqrt(1 + a^2 + c^2) / sqrt(1 + a^2) and
/// c / sqrt(1 + a^2), for gradients a along and c across.
Planar demandOf(const Gradient& gradient) noexcept;

/// Options of an equilibrium.
struct SlopeOptions {
  double max_slip = 0.8;  ///< slip above which the rover is immobilised; (0, 1], as MobilityOptions::max_slip
                          ///< (ours)
  double max_slip_angle_rad =
      /// Slip angle above which the rover slides; (0, 1.04]. The wheel model was compared with data up to 45
      /// deg (ours).
      0.7854;
};

/// Reason why there is no equilibrium.
enum class SlopeFailure {
  None,        ///< equilibrium
  Tips,        ///< the centre of mass passes the edge of the wheels
  Sinks,       ///< a wheel sinks to its axle, or by the rover's clearance
  CannotPull,  ///< no slip up to max_slip has enough drawbar pull uphill
  Slides,      ///< the wheels do not hold the rover downhill or across the slope
  Torque       ///< a wheel needs more than max_torque_Nm
};

/// Returns "holds", "tips", "sinks", "cannot pull", "slides" or "torque".
const char* name(SlopeFailure failure);

/// Steady motion over a plane, or the reason of failure. After a failure the numbers are those computed up to
/// the failure.
struct SlopeState {
  SlopeFailure failure = SlopeFailure::None;
  SlopeFailure grip =
      SlopeFailure::None;  ///< failure other than tip-over; loads are limited to those shortly before
                           ///< tip-over
  double stability_margin_rad = 0.0;  ///< RoverStance::stabilityMargin_rad() at the body's angle on the plane
  double slip = 0.0;                  ///< along the wheel planes; skid rover: mean of left and right
  double slip_angle_rad =
      0.0;  ///< from the wheel planes to the direction of travel, left positive; mean of the axles
  /// Angle of front wheels minus that of rear wheels, left positive; 0 for a skid rover.
  double steering_rad = 0.0;
  double slip_difference = 0.0;  ///< right minus left wheels of a skid rover
  /// From the direction of travel to the body, left positive; 0 for an all-wheel-steered rover.
  double body_turn_rad = 0.0;
  double sinkage_m = 0.0;             ///< of the deepest wheel
  double torque_Nm = 0.0;             ///< largest in magnitude of all wheels, signed
  double side_force_over_load = 0.0;  ///< largest |F|/N of a wheel
  double energy_J_per_m = 0.0;  ///< all wheels and hotel power, per metre of travel; braking recovers no
                                ///< energy
  double speed_mps = 0.0;       ///< travel speed at maximum rim speed
  double pull_reserve =
      0.0;  ///< change of the demand along, up or down, until failure at the same slip angle [-]; < 0: failed
  double side_reserve =
      0.0;  ///< increase of the demand across until failure at the same demand along [-]; < 0: failed

  /// Returns true if there is an equilibrium without failure.
  bool holds() const { return failure == SlopeFailure::None; }
};

/// State of one wheel at an equilibrium.
struct WheelOnSlope {
  double load_N = 0.0;  ///< normal to the plane
  double slip = 0.0;
  double slip_angle_rad = 0.0;
  double sinkage_m = 0.0;
  double torque_Nm = 0.0;
  double drawbar_pull_N = 0.0;  ///< along the wheel plane
  double side_force_N = 0.0;    ///< across the wheel plane, left positive
};

/// Equilibrium of slip and slip angle for one ground and one rover. The wheel forces, resolved along and
/// across the direction of travel, balance the weight components and have no yaw moment about the centre of
/// mass, with load transfer in pitch and roll (iagnemma_dubowsky_2004, ishigami_2009: quasi-static). The
/// demand per normal force is demandOf(). Unknowns are slip and slip angle, equal for all wheels, and one
/// difference for the yaw moment, by the kind of steering:
///   all wheels steer   the body stays in the direction of travel, front and rear wheels steer differently;
///   ackermann          the body turns with the rear wheels, the front wheels steer;
///   skid               the body turns with the wheels, left and right wheels have different slip.
/// Of several equilibria the result has the least slip angle, and then the least slip. Slip > 0 is driven, <
/// 0 braked. No wheel follows the track of another. Pitch and roll limits are not checked. Immutable, cheap
/// to copy, thread-safe.
class SlopeEquilibrium {
 public:
  /// Throws std::invalid_argument if soil, rover or an option is outside its range.
  SlopeEquilibrium(const Soil& soil, const Rover& rover, const SlopeOptions& options = {});
  SlopeEquilibrium(const RefinedModel& model, const Rover& rover, const SlopeOptions& options = {});

  /// Returns the steady motion over a plane, or the reason of failure.
  SlopeState at(const Gradient& gradient) const noexcept;

  /// Returns each wheel of a state without failure, front to rear, left before right.
  std::vector<WheelOnSlope> wheels(const Gradient& gradient, const SlopeState& state) const;

  /// Returns one wheel under its even load on level ground; slip in [-1, 1], slip angle within 60 deg.
  WheelOnSlope evenWheel(double slip, double slip_angle_rad) const noexcept;

  /// Returns true if the rover is symmetric about its longitudinal axis.
  bool symmetric() const noexcept;

  /// Returns the equilibrium without load transfer: centre of mass on the ground, in the middle of the
  /// wheels.
  SlopeEquilibrium withEvenLoads() const;

 private:
  class Solver;
  explicit SlopeEquilibrium(std::shared_ptr<const Solver> solver);
  std::shared_ptr<const Solver> solver_;
};

/// Returns the assumptions made for missing values of a rover file, one sentence each; empty for a complete
/// file.
std::vector<std::string> slopeAssumptions(const Rover& rover);

}  // namespace talus::terramech
