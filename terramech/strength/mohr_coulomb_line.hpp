#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace talus::terramech {

/// Equation c + normal tan(phi) = shear of one sample, which each linear method produces.
struct StressPair {
  double normal_Pa = 0.0;  ///< coefficient of tan(phi)
  double shear_Pa = 0.0;   ///< right-hand side
};

/// Cohesion c and friction coefficient tan(phi) of a fit with their covariance, and the parameters that the
/// data do not determine.
struct ShearStrength {
  double cohesion_Pa = 0.0;   ///< c, not clipped; a negative value indicates an error of the method
  double tan_friction = 0.0;  ///< tan(phi) [-]
  /// Covariance of (c [Pa], tan phi [-]) from the residuals; NaN with fewer than three samples.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  /// Standard deviation of the samples about the line [Pa]; NaN with fewer than three samples.
  double residual_std_Pa = 0.0;
  /// 2-norm condition number of the equations, with columns scaled to equal length [-].
  double condition = 0.0;
  std::size_t samples = 0;  ///< number of samples
  /// Parameters that the data do not determine, each with the reason; empty if all parameters are determined.
  std::vector<std::string> unseen;

  /// Returns the friction angle phi = arctan(tan_friction) [rad].
  double frictionAngle_rad() const;
};

/// Recursive least-squares fit of the line shear = c + normal tan(phi) (thesis Eqs. 2.13 to 2.16, B.9 to
/// B.12, A.2).
///
/// The memory is constant: count, means and central second moments (Welford). The result equals the batch
/// solution within rounding, while the normal equations as printed lose accuracy for almost equal stresses.
/// Copyable; const members are thread-safe.
class MohrCoulombLine {
 public:
  /// Adds the equation of one sample in constant time. `weight` > 0 [-] is the inverse of the relative
  /// variance of the sample's shear.
  void add(StressPair pair, double weight = 1.0);

  /// Returns the least-squares line of all samples. Throws std::domain_error with fewer than two samples, or
  /// if all normal stresses are equal.
  ShearStrength estimate() const;

  /// Returns sqrt(sum of weighted squared residuals / number of samples) [Pa times square root of weight]; 0
  /// with fewer than three samples.
  double relativeResidual() const;

  std::size_t samples() const { return count_; }

 private:
  std::size_t count_ = 0;
  double weight_ = 0.0;
  double mean_normal_ = 0.0;
  double mean_shear_ = 0.0;
  double normal_normal_ = 0.0;  // sum w (x - mean x)^2
  double normal_shear_ = 0.0;
  double shear_shear_ = 0.0;
};

/// Returns the entries of ShearStrength::unseen for a fit. A parameter is undetermined if the condition
/// number exceeds kWorstCondition, or if its standard deviation exceeds half the range of soils (limits
/// ours).
std::vector<std::string> unseenStrength(const ShearStrength& fit);

/// Greatest scaled condition number of a determined fit. Above this number a reading error of 1 % changes
/// tan(phi) by more than the differences between soils (ours).
inline constexpr double kWorstCondition = 200.0;

}  // namespace talus::terramech
