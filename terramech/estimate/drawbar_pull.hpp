#pragma once

#include <array>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>

namespace talus::terramech {

/// Estimates of the drawbar pull divided by load, DP/W [-], from readings of load W, torque T, sinkage z and,
/// in one method, slip i, without soil parameters (thesis chapter 3). theta_1 = arccos(1 - z/r) is the entry
/// angle. The rms errors over thesis Table 2.1 without noise are 0.013 (Eqs. 3.6 and 3.15), 0.028 (Eq. 3.21)
/// and 0.002 (ours). Every function throws std::invalid_argument unless load_N > 0; functions that use
/// theta_1 also unless 0 <= sinkage_m < 2 r.

/// Returns the torque ratio T/(rW) [-] of a sample.
double torqueOverLoadRadius(const Wheel& wheel, const WheelSample& sample);

/// Returns DP/W under the assumption that a single force at the rim angle theta = theta_rad carries load and
/// torque: DP/W = T/(r W cos theta) - tan(theta) (thesis Eq. 3.4).
double pullOfSingleForce(const Wheel& wheel, const WheelSample& sample, double theta_rad);

/// Returns DP/W = T/(rW) - theta_1/2, an approximation for small theta_1 (thesis Eqs. 3.6 and 3.15; erratum:
/// the printed z/r ~ theta_1 should be z/r ~ theta_1^2/2).
double pullAtSmallAngle(const Wheel& wheel, const WheelSample& sample);

/// Returns DP/W under the assumption of triangular stresses (thesis Eq. 3.12), in a form that does not cancel
/// at small angles:
///     DP/W = (sin(theta_1/4) / (theta_1/4))^2 / cos(theta_1/2) T/(rW) - tan(theta_1/2)
double pullOfTriangularStress(const Wheel& wheel, const WheelSample& sample);

/// Linear formula for the drawbar pull: the plane DP/W = C1 T/(rW) + C2 z/r + C3 (thesis Eq. 3.16).
struct PullPlane {
  double c1 = 1.0;   ///< C1 [-]
  double c2 = -1.0;  ///< C2 [-]
  double c3 = -0.1;  ///< C3 [-]

  /// Returns DP/W [-] of a sample by this formula.
  double at(const Wheel& wheel, const WheelSample& sample) const;
};

/// Plane from simulations (thesis Eqs. 3.20, 3.21).
inline constexpr PullPlane kThesisPlane{1.0, -1.0, -0.1};
/// Model of the rim angle theta at which a single equivalent force acts: theta = (a0 + a1 i + a2 theta_1 + a3
/// T/(rW)) theta_1 (ours).
struct PullAngleModel {
  double a0 = 0.4597;
  double a1 = 0.0953;
  double a2 = 0.0206;
  double a3 = 0.0407;
  double std = 0.005;  ///< model error of DP/W for exact readings [-]

  /// Returns the angle theta [rad] of a sample.
  double angle_rad(const Wheel& wheel, const WheelSample& sample) const;
};

/// Returns DP/W of a single force (thesis Eq. 3.4) at the rim angle of `model` (ours). The standard deviation
/// includes the errors of the readings and of the model. The four coefficients of the model were fitted to
/// Wong-Reece simulations: soils of thesis Table 2.1, radius r 0.05 to 0.25 m, width 0.4 to 1.5 r, slip 0.05
/// to 0.95, z/r below 0.6, with the wheel of the thesis in half of the simulations. The rms error is 0.002
/// for the wheel of the thesis, 0.003 for the other wheels, and 0.007 for soils far outside Table 2.1.
Estimate pullOverLoad(const Wheel& wheel, const WheelSample& sample,
                      const ReadingErrors& noise = ReadingErrors::relative(0.0),
                      const PullAngleModel& model = {});

/// Returns the slope arctan(DP/W) [rad] that a wheel with this drawbar pull over load can climb, with its
/// standard deviation (thesis 3.5).
Estimate climbableSlope_rad(const Estimate& pull_over_load);

/// Drawbar pull and sinkage of a wheel at one load on one soil.
struct PullForecast {
  Estimate at_reference;         ///< DP/W (drawbar pull over load) at the reference slip
  Estimate most;                 ///< maximum DP/W over slip
  double most_slip = 0.0;        ///< mean slip of maximum DP/W [-]
  Estimate sinkage_over_radius;  ///< sinkage over radius, z/r, at the reference slip
  Estimate climbable_slope_rad;  ///< climbable slope arctan(most)
};

/// Slips [-] among which the maximum pull is searched.
inline constexpr std::array kForecastSlips{0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};

}  // namespace talus::terramech
