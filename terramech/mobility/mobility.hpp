#pragma once

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/numerics/monotone_curve.hpp>

/// The state of a rover driving on a slope of a soil: slip, torque and energy along the heading.
namespace talus::terramech {

/// Choices behind a mobility curve.
struct MobilityOptions {
  double reference_slip = 0.5;  ///< slip that traversability is judged at, (0, 1) (thesis 3.5)
  double max_slip = 0.8;        ///< more than this counts as stuck and without steering, (0, 1] (ours)
  int first_pass = 1;  ///< pass of the first axle over its track, >= 1: 2 in the rut of an equal wheel
  int axles = 1;       ///< that roll in one another's tracks, >= 1: the k-th at pass first_pass + k - 1
};

/// A rover driving steadily along a slope.
struct MobilityState {
  double slip = 0.0;       ///< driven in [0, 1], braked in [-1, 0)
  double sinkage_m = 0.0;  ///< of each wheel; of the first axle where they differ
  double torque_Nm = 0.0;  ///< of each wheel, the mean where axles differ; negative when it brakes
  /// All wheels and hotel power, per metre driven along the surface; braking gives none back.
  double energy_J_per_m = 0.0;
  double speed_mps = 0.0;  ///< over the ground, along the surface
  /// Pull that is left, over the load [-]: the least of DP/N at the reference slip less tan(slope), and
  /// tan(slope) less DP/N of a locked wheel; < 0 when it must fail.
  double drawbar_pull_margin = 0.0;
  bool feasible = false;  ///< slip <= max_slip, |torque| <= the rover's, the locked wheels hold downhill
};

/// A wheel at a stated slip under its load on the flat.
struct MobilityReference {
  double slip = 0.0;
  double drawbar_pull_over_load = 0.0;  ///< DP/W [-]
  double sinkage_over_radius = 0.0;  ///< z/r [-]; 1 when the soil cannot carry the wheel: it lies on its axle
  double torque_over_load_radius = 0.0;  ///< T/(rW) [-]
};

struct MobilitySolver;  ///< inner: where a curve has the forces of a wheel from

/// Slope along the heading to slip, sinkage, torque, energy and speed, for one soil and one rover in its own
/// gravity. On a slope alpha each of the equal wheels carries W cos(alpha) and must pull W sin(alpha), so
/// DP/N = tan(alpha). Load transfer between axles is left out. Tabulated over slip, where the curve is
/// smooth, and read with monotone cubic interpolation: slip within 1e-3 of the exact solution, and never
/// falling while the slope rises. Immutable; safe to share between threads.
class MobilityCurve {
 public:
  /// Throws std::invalid_argument when soil, rover or options leave their range. A soil that cannot carry the
  /// wheel at all is not an error: nothing is feasible on it.
  MobilityCurve(const Soil& soil, const Rover& rover, const MobilityOptions& options = {});

  /// The same of a model with effects. Those of sensors do not act on the soil and are left out; those on
  /// columns that a drive does not have (a dust index, a session) stay neutral; slope, speed and rim speed
  /// (the rover's greatest), and the pass of each axle are known: where an effect of passes is among them the
  /// axles are solved one by one, under equal loads, and their pulls and torques averaged. The table is
  /// monotone all the same: where effects make the pull fall with slip, the lesser slip holds. Throws as
  /// above, and for a linear-formula base, which needs a measured torque.
  MobilityCurve(const RefinedModel& model, const Rover& rover, const MobilityOptions& options = {});

  /// State on a slope along the heading, uphill > 0, in (-pi/2, pi/2). Where the slope is out of reach the
  /// state is that of the nearest slope that can be reached, with `feasible` false.
  MobilityState at(double slope_rad) const noexcept;

  /// The steepest slopes [rad] that the soil can hold the rover on, up (> 0 on good ground) and down, torque
  /// apart. max < min when the soil cannot carry the wheel.
  double maxSlope_rad() const noexcept { return max_slope_rad_; }
  double minSlope_rad() const noexcept { return min_slope_rad_; }

  /// At the reference slip, for categorise().
  const MobilityReference& reference() const noexcept { return reference_; }

  /// At the slip of greatest drawbar pull.
  const MobilityReference& strongest() const noexcept { return strongest_; }

 private:
  void tabulate(const MobilitySolver& solver);

  Rover rover_;
  MobilityOptions options_;
  MonotoneCurve slip_, sinkage_m_, torque_Nm_;
  double min_slope_rad_ = 0.0, max_slope_rad_ = -1.0;
  double locked_pull_ = 0.0;  // DP/N of the strongest braking
  MobilityReference reference_, strongest_;
};

/// MobilityCurve::reference() without the curve, which takes a hundred times as long. Throws as MobilityCurve does.
MobilityReference mobilityReference(const Soil& soil, const Rover& rover,
                                    const MobilityOptions& options = {});
MobilityReference mobilityReference(const RefinedModel& model, const Rover& rover,
                                    const MobilityOptions& options = {});

/// The state on one slope by root finding instead of the table, 200 times slower: what the table is tested
/// against. `slope_rad` within [minSlope_rad(), maxSlope_rad()]; throws std::domain_error outside.
double slipOnSlope(const Soil& soil, const Rover& rover, double slope_rad);

}  // namespace talus::terramech
