#pragma once

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/numerics/monotone_curve.hpp>

/// State of a rover that drives straight up or down a slope: slip, torque, energy and speed along the
/// heading.
namespace talus::terramech {

/// Options of a MobilityCurve.
struct MobilityOptions {
  double reference_slip = 0.5;  ///< slip at which traversability is assessed, (0, 1) (thesis 3.5)
  double max_slip = 0.8;  ///< slip above which the wheel is immobilised and not steerable, (0, 1] (ours)
  /// Pass number of the first axle over its track, >= 1; 2: the axle runs in the rut of an equal wheel.
  int first_pass = 1;
  int axles = 1;  ///< number of axles in one track, >= 1; axle k = 1 ... axles is pass first_pass + k - 1
};

/// State of a rover in steady motion up or down a slope.
struct MobilityState {
  double slip = 0.0;       ///< wheel slip, driven in [0, 1], braked in [-1, 0)
  double sinkage_m = 0.0;  ///< sinkage of each wheel; if the axles differ, of the first axle
  double torque_Nm = 0.0;  ///< torque of each wheel, negative when braking; if the axles differ, their mean
  /// Energy of all wheels and hotel power (power independent of driving) per metre along the surface. Braking
  /// recovers no energy.
  double energy_J_per_m = 0.0;
  double speed_mps = 0.0;  ///< travel speed along the surface
  /// Drawbar-pull margin over the normal load N [-]: the smaller of (DP/N at the reference slip) - tan(slope)
  /// and tan(slope) - (DP/N of a locked wheel). A negative first term means that the slope requires more than
  /// the reference slip.
  double drawbar_pull_margin = 0.0;
  /// True if the slope is in [minSlope_rad(), maxSlope_rad()], slip <= max_slip and |torque| <=
  /// max_torque_Nm.
  bool feasible = false;
};

/// State of a wheel with load W and radius r at a given slip on level ground.
struct MobilityReference {
  double slip = 0.0;                     ///< the given slip [-]
  double drawbar_pull_over_load = 0.0;   ///< drawbar pull over load, DP/W [-]
  double sinkage_over_radius = 0.0;      ///< sinkage over radius, z/r [-]; 1: the soil cannot carry the wheel
  double torque_over_load_radius = 0.0;  ///< torque ratio T/(rW) [-]
};

struct MobilitySolver;  ///< Private: computes the wheel forces for a MobilityCurve.

/// Slip, sinkage, torque, energy and speed of a rover as functions of the slope along the heading, for one
/// soil and one rover in its own gravity. On a slope alpha each of the equal wheels carries N = W cos(alpha)
/// and needs the drawbar pull DP = W sin(alpha), so that DP/N = tan(alpha). Load transfer between axles is
/// neglected. The curve is tabulated over slip, as a smooth function of slip, and evaluated by monotone cubic
/// interpolation: the slip is within 1e-3 of the exact solution and never decreases with the slope.
/// Immutable; safe to share between threads.
class MobilityCurve {
 public:
  /// Tabulates the curve of a soil. Throws std::invalid_argument if soil, rover or options are outside their
  /// range. If the soil cannot carry the wheel, the curve is valid and no slope is feasible.
  MobilityCurve(const Soil& soil, const Rover& rover, const MobilityOptions& options = {});

  /// Tabulates the curve of a wheel model with effects (corrections to Wong-Reece). Effects that are sensor
  /// errors are ignored. An effect acts only if its covariate, the quantity on which the effect depends, is
  /// known; known are slope, speed, rim speed (the rover's maximum) and the pass of each axle, unknown are
  /// for example a dust index or a session. With a multipass effect each axle is solved separately under an
  /// equal load, and the pulls and torques of the axles are averaged. If the pull falls with slip, the lower
  /// slip is used, so that the table is monotone. Throws std::invalid_argument for arguments outside their
  /// range, and for the base model linear-formula, which needs a measured torque.
  MobilityCurve(const RefinedModel& model, const Rover& rover, const MobilityOptions& options = {});

  /// Returns the state of the rover on a slope along the heading, uphill > 0, in (-pi/2, pi/2). Beyond
  /// minSlope_rad() or maxSlope_rad() slip, sinkage, torque, speed and energy are those of the nearer of
  /// these two slopes, and `feasible` is false.
  MobilityState at(double slope_rad) const noexcept;

  /// Return the steepest slopes [rad] on which a constant speed is possible without regard to the torque
  /// limit: uphill (> 0 on firm soil) and downhill. The maximum is less than the minimum if the soil cannot
  /// carry the wheel.
  double maxSlope_rad() const noexcept { return max_slope_rad_; }
  double minSlope_rad() const noexcept { return min_slope_rad_; }

  /// Returns the state of a wheel at the reference slip on level ground, the input of categorise().
  const MobilityReference& reference() const noexcept { return reference_; }

  /// Returns the state of a wheel at the slip of maximum drawbar pull on level ground.
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

/// Return the value of MobilityCurve::reference() at about a hundredth of the cost of a curve. Throw the
/// exceptions of the constructors of MobilityCurve.
MobilityReference mobilityReference(const Soil& soil, const Rover& rover,
                                    const MobilityOptions& options = {});
MobilityReference mobilityReference(const RefinedModel& model, const Rover& rover,
                                    const MobilityOptions& options = {});

}  // namespace talus::terramech
