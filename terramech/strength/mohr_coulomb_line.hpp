#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace talus::terramech {

/// One equation c + normal tan(phi) = shear: what each linear method makes of a sample.
struct StressPair {
  double normal_Pa = 0.0;
  double shear_Pa = 0.0;
};

/// Cohesion and friction with their uncertainty, and the parameters that were not identifiable.
struct ShearStrength {
  double cohesion_Pa = 0.0;   ///< c; not clipped: a negative value shows the method's error
  double tan_friction = 0.0;  ///< tan(phi) [-]
  /// Of (c [Pa], tan phi [-]), from the residual scatter: [Pa^2, Pa; Pa, -]. NaN with fewer than three
  /// samples.
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  double residual_std_Pa = 0.0;  ///< scatter about the line [Pa]
  double condition = 0.0;        ///< 2-norm condition number of K_1 with its columns scaled equally [-]
  std::size_t samples = 0;
  /// Parameters that the data cannot see, each with the reason; empty: all seen.
  std::vector<std::string> unseen;

  /// phi = arctan(tan_friction) [rad].
  double frictionAngle_rad() const;
};

/// Recursive least squares of shear = c + normal tan(phi) (thesis Eqs. 2.13 to 2.16, B.9 to B.12, A.2).
///
/// Constant memory: count, means and centred second moments (Welford), which equals the batch solution to
/// rounding and, unlike the normal equations as printed, does not lose it when the stresses hardly vary. A
/// value type; const is thread-safe.
class MohrCoulombLine {
 public:
  /// Takes one sample in; constant time. A weight [-], > 0, is one over the relative variance of the pair's
  /// shear.
  void add(StressPair pair, double weight = 1.0);

  /// Least-squares line of all samples so far. Throws std::domain_error with fewer than two samples or when
  /// all normal stresses are equal, naming what cannot be seen.
  ShearStrength estimate() const;

  /// Root of the weighted mean square about the line [Pa times root of weight]; 0 with fewer than three
  /// samples.
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

/// Names in `unseen` what a spread of the normal stress this small leaves open; empty when conditioning is
/// good. Limits are ours: condition number above kWorstCondition, or a standard deviation as wide as soils
/// differ.
std::vector<std::string> unseenStrength(const ShearStrength& fit);

/// Above this scaled condition number 1 % of noise on a reading moves tan(phi) by more than soils differ
/// (ours).
inline constexpr double kWorstCondition = 200.0;

}  // namespace talus::terramech
