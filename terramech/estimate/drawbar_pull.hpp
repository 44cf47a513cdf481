#pragma once

#include <cstddef>

#include <Eigen/Core>

#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/estimate/reading_errors.hpp>
#include <talus/terramech/numerics/estimate.hpp>

/// Estimates of the drawbar pull divided by load, DP/W [-], from readings of load W, torque T, sinkage z and,
/// in one method, slip i, without soil parameters (thesis chapter 3). theta_1 = arccos(1 - z/r) is the entry
/// angle. The rms errors over thesis Table 2.1 without noise are 0.013 (Eqs. 3.6 and 3.15), 0.028 (Eq. 3.21)
/// and 0.002 (ours). Every function throws std::invalid_argument unless load_N > 0; functions that use
/// theta_1 also unless 0 <= sinkage_m < 2 r.
namespace talus::terramech {

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
/// Plane from two measured soils (thesis 3.4).
inline constexpr PullPlane kThesisExperimentPlane{1.5, -1.0, -0.2};

/// Plane fitted to samples, with its covariance and residual.
struct PullPlaneFit {
  PullPlane plane;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of (C1, C2, C3)
  double residual_std = 0.0;  ///< rms residual of DP/W about the plane, with n - 3 degrees of freedom [-]
  std::size_t samples = 0;    ///< number n of samples
};

/// Recursive least-squares fit of a PullPlane (thesis Eqs. 3.16 to 3.19) in constant memory.
class PullPlaneFitter {
 public:
  /// Adds a sample and its measured or simulated DP/W = pull_over_load.
  void add(const Wheel& wheel, const WheelSample& sample, double pull_over_load);

  /// Returns the fitted plane. Throws std::domain_error if there are fewer than four samples, or if the
  /// samples lie on a line in the plane of T/(rW) and z/r.
  PullPlaneFit estimate() const;

 private:
  Eigen::Matrix4d gram_ = Eigen::Matrix4d::Zero();  // Gram matrix of (T/(rW), z/r, 1, DP/W)
  std::size_t count_ = 0;
};

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

}  // namespace talus::terramech
