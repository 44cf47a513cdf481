#pragma once

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/numerics/monotone_curve.hpp>

/// State of a rover that drives on a slope: slip, torque and energy along the heading.
namespace talus::terramech {

/// Options of a mobility curve.
struct MobilityOptions {
  double reference_slip = 0.5;  ///< slip at which traversability is assessed, (0, 1) (thesis 3.5)
  double max_slip = 0.8;        ///< above this slip the wheel is immobilised and not steerable, (0, 1] (ours)
  int first_pass = 1;  ///< pass of the first axle over its track, >= 1; 2: in the rut of an equal wheel
  int axles = 1;       ///< number of axles in one track, >= 1; axle k is at pass first_pass + k - 1
};

/// State of a rover in steady motion along a slope.
struct MobilityState {
  double slip = 0.0;       ///< driven in [0, 1], braked in [-1, 0)
  double sinkage_m = 0.0;  ///< of each wheel; of the first axle if axles differ
  double torque_Nm = 0.0;  ///< of each wheel; the mean if axles differ; negative when braking
  /// Energy of all wheels and hotel power per metre along the surface; braking recovers no energy.
  double energy_J_per_m = 0.0;
  double speed_mps = 0.0;  ///< travel speed along the surface
  /// Drawbar-pull margin over load [-]: the smaller of DP/N at the reference slip minus tan(slope), and
  /// tan(slope) minus DP/N of a locked wheel. Negative: the slope is infeasible.
  double drawbar_pull_margin = 0.0;
  /// Slope in [minSlope_rad(), maxSlope_rad()], slip <= max_slip, |torque| <= max_torque_Nm.
  bool feasible = false;
};

/// Wheel at a given slip under its load on level ground.
struct MobilityReference {
  double slip = 0.0;
  double drawbar_pull_over_load = 0.0;   ///< DP/W [-]
  double sinkage_over_radius = 0.0;      ///< z/r [-]; 1: the soil cannot carry the wheel
  double torque_over_load_radius = 0.0;  ///< T/(rW) [-]
};

struct MobilitySolver;  ///< Private: computes the forces of a curve.

/// Slip, sinkage, torque, energy and speed as functions of the slope along the heading, for one soil and one
/// rover in its own gravity. On a slope alpha each of the equal wheels carries W cos(alpha) and needs the
/// pull W sin(alpha), so that DP/N = tan(alpha). Load transfer between axles is neglected. The curve is
/// tabulated over slip, where it is smooth, and read with monotone cubic interpolation: slip is within 1e-3
/// of the exact solution and never decreases with the slope. Immutable; safe to share between threads.
class MobilityCurve {
 public:
  /// Throws std::invalid_argument if soil, rover or options are outside their range. If the soil cannot carry
  /// the wheel, the curve is valid and no slope is feasible.
  MobilityCurve(const Soil& soil, const Rover& rover, const MobilityOptions& options = {});

  /// Curve of a model with effects. Sensor errors are ignored; effects with unknown covariates (a dust index,
  /// a session) do not act. Known covariates are slope, speed, rim speed (the rover's maximum) and the pass
  /// of each axle. With a multipass effect each axle is solved separately under an equal load, and the pulls
  /// and torques are averaged. If the pull falls with slip, the lower slip is used, so that the table is
  /// monotone. Throws std::invalid_argument as above, and for the base linear-formula, which needs a measured
  /// torque.
  MobilityCurve(const RefinedModel& model, const Rover& rover, const MobilityOptions& options = {});

  /// Returns the state on a slope along the heading, uphill > 0, in (-pi/2, pi/2). Beyond the feasible slopes
  /// slip, sinkage, torque, speed and energy are those of the nearest feasible slope, and `feasible` is
  /// false.
  MobilityState at(double slope_rad) const noexcept;

  /// Steepest slopes [rad] on which a constant speed is possible, uphill (> 0 on firm soil) and downhill,
  /// without the torque limit; max < min if the soil cannot carry the wheel.
  double maxSlope_rad() const noexcept { return max_slope_rad_; }
  double minSlope_rad() const noexcept { return min_slope_rad_; }

  /// Returns the wheel at the reference slip, for categorise().
  const MobilityReference& reference() const noexcept { return reference_; }

  /// Returns the wheel at the slip of maximum drawbar pull.
  const MobilityReference& strongest() const noexcept { return strongest_; }

 private:
  void tabulate(const MobilitySolver& solver);

  Rover rover_;
  MobilityOptions options_;
  MonotoneCurve slip_, sinkage_m_, torque_Nm_;
  double min_slope_rad_ = 0.0, max_slope_rad_ = -1.0;
  double locked_pull_ = 0.0;  // DP/N at the lower end of the table
  MobilityReference reference_, strongest_;
};

/// Returns MobilityCurve::reference() at about a hundredth of the cost of a curve. Throws as MobilityCurve.
MobilityReference mobilityReference(const Soil& soil, const Rover& rover,
                                    const MobilityOptions& options = {});
MobilityReference mobilityReference(const RefinedModel& model, const Rover& rover,
                                    const MobilityOptions& options = {});

/// Returns the slip on one slope by root finding, 200 times slower than the table; reference for tests of the
/// table. Throws std::domain_error for a slope outside [minSlope_rad(), maxSlope_rad()].
double slipOnSlope(const Soil& soil, const Rover& rover, double slope_rad);

}  // namespace talus::terramech
