#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/estimate/reading_errors.hpp>
#include <talus/terramech/numerics/estimate.hpp>

/// Drawbar pull divided by load, DP/W [-], from readings of load, torque, sinkage (and slip), without soil
/// parameters (thesis chapter 3). The rms errors over thesis Table 2.1 without noise are 0.013 (Eqs. 3.6 and
/// 3.15), 0.028 (Eq. 3.21) and 0.002 (ours). Every function throws std::invalid_argument unless load_N > 0;
/// functions that use theta_1 also unless 0 <= sinkage_m < 2 r.
namespace talus::terramech {

/// Returns T/(rW) [-].
double torqueOverLoadRadius(const Wheel& wheel, const WheelSample& sample);

/// Returns DP/W for a single force at angle theta of the rim that carries load and torque: T/(r W cos theta)
/// - tan(theta) (thesis Eq. 3.4).
double pullOfSingleForce(const Wheel& wheel, const WheelSample& sample, double theta_rad);

/// Returns DP/W = T/(rW) - theta_1/2 (thesis Eqs. 3.6 and 3.15; erratum: the printed z/r ~ theta_1 should be
/// z/r ~ theta_1^2/2).
double pullAtSmallAngle(const Wheel& wheel, const WheelSample& sample);

/// Returns DP/W for triangular stresses (thesis Eq. 3.12), simplified to a form that does not cancel at small
/// angles:
///     DP/W = (sin(theta_1/4) / (theta_1/4))^2 / cos(theta_1/2) T/(rW) - tan(theta_1/2)
double pullOfTriangularStress(const Wheel& wheel, const WheelSample& sample);

/// Plane DP/W = C1 T/(rW) + C2 z/r + C3 (thesis Eq. 3.16).
struct PullPlane {
  double c1 = 1.0;
  double c2 = -1.0;
  double c3 = -0.1;

  /// Returns DP/W [-] of a sample.
  double at(const Wheel& wheel, const WheelSample& sample) const;
};

inline constexpr PullPlane kThesisPlane{1.0, -1.0, -0.1};  ///< from simulations (thesis Eqs. 3.20, 3.21)
inline constexpr PullPlane kThesisExperimentPlane{1.5, -1.0, -0.2};  ///< from two measured soils (thesis 3.4)

/// Fitted plane with its covariance and residual.
struct PullPlaneFit {
  PullPlane plane;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of (C1, C2, C3)
  double residual_std = 0.0;  ///< rms about the plane, n - 3 degrees of freedom [-]
  std::size_t samples = 0;
};

/// Recursive least-squares fit of the plane (thesis Eqs. 3.16 to 3.19) in constant memory.
class PullPlaneFitter {
 public:
  /// Adds a sample with its measured or simulated DP/W.
  void add(const Wheel& wheel, const WheelSample& sample, double pull_over_load);

  /// Returns the fitted plane. Throws std::domain_error with fewer than four samples, or if the samples lie
  /// on a line in (T/rW, z/r).
  PullPlaneFit estimate() const;

 private:
  Eigen::Matrix4d gram_ = Eigen::Matrix4d::Zero();  // of (T/rW, z/r, 1, DP/W)
  std::size_t count_ = 0;
};

/// Angle of the equivalent single force on the rim, theta = (a0 + a1 i + a2 theta_1 + a3 T/(rW)) theta_1
/// (ours).
struct PullAngleModel {
  double a0 = 0.4597;
  double a1 = 0.0953;
  double a2 = 0.0206;
  double a3 = 0.0407;
  double std = 0.005;  ///< model error of DP/W with exact readings [-]

  /// Returns theta [rad] of a sample.
  double angle_rad(const Wheel& wheel, const WheelSample& sample) const;
};

/// Returns DP/W by thesis Eq. 3.4 at the angle of the model (ours). The standard deviation includes the
/// errors of the readings and of the model. The four coefficients were fitted to Wong-Reece simulations:
/// soils of thesis Table 2.1, radius 0.05 to 0.25 m, width 0.4 to 1.5 r, slip 0.05 to 0.95, z/r below 0.6,
/// and half of the simulations with the wheel of the thesis. rms error: 0.002 for the thesis' wheel, 0.003
/// for the others, 0.007 for soils far outside Table 2.1.
Estimate pullOverLoad(const Wheel& wheel, const WheelSample& sample,
                      const ReadingErrors& noise = ReadingErrors::relative(0.0),
                      const PullAngleModel& model = {});

/// Returns the slope [rad] that a wheel with this DP/W can climb, arctan(DP/W), with its standard deviation
/// (thesis 3.5).
Estimate climbableSlope_rad(const Estimate& pull_over_load);

}  // namespace talus::terramech
