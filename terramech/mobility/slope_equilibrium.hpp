#pragma once

#include <memory>
#include <string>
#include <vector>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>

/// A rover that drives steadily over an inclined plane in any direction: the slip and the slip angle at which
/// its wheels hold it.
namespace talus::terramech {

struct Planar;
struct RefinedModel;

/// The plane as the way over it sees it: rise over horizontal run [-].
struct Gradient {
  double along = 0.0;   ///< uphill > 0
  double across = 0.0;  ///< rising to the left > 0
};

/// What a rover must hold per unit of the force normal to the plane, along and across: a sqrt(1 + a^2 + c^2) / sqrt(1 + a^2) and
/// c / sqrt(1 + a^2), for gradients a along and c across.
Planar demandOf(const Gradient& gradient) noexcept;

/// Choices behind an equilibrium.
struct SlopeOptions {
  double max_slip = 0.8;  ///< more counts as stuck, (0, 1], as MobilityOptions (ours)
  double max_slip_angle_rad =
      0.7854;  ///< more counts as sliding, (0, 1.04]: wheels were held against data to 45 deg (ours)
};

/// Why nothing holds.
enum class SlopeFailure {
  None,        ///< it holds
  Tips,        ///< the centre of mass passes over the wheels
  Sinks,       ///< a wheel sinks to its axle, or by the rover's clearance
  CannotPull,  ///< no slip up to max_slip pulls it up
  Slides,      ///< the wheels do not hold it down or across the slope
  Torque       ///< a wheel takes more torque than the rover has
};

/// "holds", "tips", "sinks", "cannot pull", "slides" or "torque".
const char* name(SlopeFailure failure);

/// A rover in steady motion over a plane, or the reason why there is none; the numbers below `failure` are
/// then what was found until it failed.
struct SlopeState {
  SlopeFailure failure = SlopeFailure::None;
  SlopeFailure grip =
      SlopeFailure::None;  ///< the same of a rover that cannot tip: loads beyond are those shortly before
  double stability_margin_rad =
      0.0;            ///< RoverStance::stabilityMargin_rad() of the body as it lies on the plane
  double slip = 0.0;  ///< of the wheels along their planes; the mean of left and right of a skid rover
  double slip_angle_rad =
      0.0;  ///< from the wheels' planes to the way made good, left positive; the mean of the axles
  double steering_rad = 0.0;  ///< by which front wheels point further left than rear ones; of a skid rover 0
  double slip_difference = 0.0;  ///< right less left wheels, of a skid rover
  double body_turn_rad = 0.0;    ///< of the body from the way made good, left positive: 0 of one that crabs
  double sinkage_m = 0.0;        ///< of the deepest wheel
  double torque_Nm = 0.0;        ///< of the wheel with the greatest, signed
  double side_force_over_load = 0.0;  ///< greatest |F|/N of a wheel
  double energy_J_per_m =
      0.0;  ///< all wheels and hotel power, per metre of way made good; braking gives none back
  double speed_mps = 0.0;  ///< of the way made good, at the rover's greatest rim speed
  double pull_reserve =
      0.0;  ///< [-] by which the demand along could grow, or fall, with the slip angle kept; < 0: fails
  double side_reserve =
      0.0;  ///< [-] by which the demand across could grow with the demand along kept; < 0: fails

  bool holds() const { return failure == SlopeFailure::None; }
};

/// A wheel of it.
struct WheelOnSlope {
  double load_N = 0.0;  ///< normal to the plane
  double slip = 0.0;
  double slip_angle_rad = 0.0;
  double sinkage_m = 0.0;
  double torque_Nm = 0.0;
  double drawbar_pull_N = 0.0;  ///< along its plane
  double side_force_N = 0.0;    ///< across it, left positive
};

/// Finds slip and slip angle for one ground and rover. The wheels' forces, turned into the direction of the
/// way made good, balance the weight along and across it and leave no yaw moment about the centre of mass,
/// under loads with transfer in pitch and roll (iagnemma_dubowsky_2004, ishigami_2009: quasi-static). Per
/// unit of the force normal to the plane they must give a sqrt(1 + a^2 + c^2) / sqrt(1 + a^2) along and c /
/// sqrt(1 + a^2) across, for gradients a along and c across. Unknowns: slip and slip angle, the same of all
/// wheels, and for the yaw moment, by the kind of steering,
///   all wheels steer   the body keeps to the way, front and rear wheels steer apart;
///   ackermann          the body turns with the rear wheels, the front wheels steer;
///   skid               the body turns with the wheels, left and right wheels slip apart.
/// Of several equilibria the one with the least slip angle, and there the least slip, is taken. Driving is
/// slip > 0, braking < 0. No wheel follows another's track. Limits of pitch and roll are not looked at.
/// Immutable, cheap to copy, thread-safe.
class SlopeEquilibrium {
 public:
  /// Throws std::invalid_argument for a soil or rover out of its range and when an option leaves its own.
  SlopeEquilibrium(const Soil& soil, const Rover& rover, const SlopeOptions& options = {});
  SlopeEquilibrium(const RefinedModel& model, const Rover& rover, const SlopeOptions& options = {});

  SlopeState at(const Gradient& gradient) const noexcept;

  /// Each wheel of a state that holds, front to rear, left before right.
  std::vector<WheelOnSlope> wheels(const Gradient& gradient, const SlopeState& state) const;

  /// One wheel under its even share of the weight on the flat; slip within [-1, 1], slip angle within 60 deg.
  WheelOnSlope evenWheel(double slip, double slip_angle_rad) const noexcept;

  /// Whether the rover is alike on its left and right.
  bool symmetric() const noexcept;

  /// The same wheels on a rover that no slope moves load in: its centre of mass on the ground, in the middle.
  SlopeEquilibrium withEvenLoads() const;

 private:
  class Solver;
  explicit SlopeEquilibrium(std::shared_ptr<const Solver> solver);
  std::shared_ptr<const Solver> solver_;
};

/// What is taken for granted where a rover file leaves it open, one sentence each; empty where nothing is.
std::vector<std::string> slopeAssumptions(const Rover& rover);

}  // namespace talus::terramech
