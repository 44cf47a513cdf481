#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/contact/wheel_on_soil.hpp>

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

/// Weighted means and central moments of pairs (x, y), one pair at a time (Welford).
struct PairMoments {
  double weight = 0.0, x = 0.0, y = 0.0;  ///< sum of weights, and means
  double xx = 0.0, xy = 0.0, yy = 0.0;    ///< weighted sums of products of deviations from the means

  void add(double new_x, double new_y, double w = 1.0) {
    const double dx = new_x - x, dy = new_y - y;
    weight += w;
    x += dx * w / weight;
    y += dy * w / weight;
    xx += w * dx * (new_x - x);
    xy += w * dx * (new_y - y);
    yy += w * dy * (new_y - y);
  }
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
  PairMoments moments_;  // of normal and shear stress
};

/// Returns the entries of ShearStrength::unseen for a fit. A parameter is undetermined if the condition
/// number exceeds kWorstCondition, or if its standard deviation exceeds half the range of soils (limits
/// ours).
std::vector<std::string> unseenStrength(const ShearStrength& fit);

/// Greatest scaled condition number of a determined fit. Above this number a reading error of 1 % changes
/// tan(phi) by more than the differences between soils (ours).
inline constexpr double kWorstCondition = 200.0;

/// Wheel method of Iagnemma for cohesion and friction angle. The stresses are triangular along the rim with
/// the peak at theta_m = theta_1/2, half the entry angle (thesis App. B.3; iagnemma_2002). The method
/// over-estimates the cohesion of cohesive soil: without noise, by about 5 kPa on clay of 6 kPa. The
/// corrected method is linearOffset().

/// Peak stresses of the triangular stress distributions along the rim.
struct PeakStresses {
  double normal_Pa = 0.0;  ///< peak normal stress sigma_m
  double shear_Pa = 0.0;   ///< peak shear stress tau_m
};

/// Returns the peak stresses that carry the load and torque of a sample (thesis Eqs. B.6, B.7). Throws
/// std::invalid_argument unless 0 < sinkage < 2 r.
PeakStresses trianglePeaks(const Wheel& wheel, const WheelSample& sample);

/// Returns the equation c + K_j1 tan(phi) = K_j2 of one sample for a given shear modulus K (thesis Eqs. B.8,
/// B.11, B.12). The result is input of MohrCoulombLine. Throws std::domain_error if no shear is mobilised at
/// theta_m, i.e. the mobilised fraction A is <= 0; this occurs for a wheel with almost no slip and for a
/// braked wheel.
StressPair iagnemmaPair(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m);

/// Wheel-spin test of the Sojourner rover: a wheel is turned in place, and the stresses are assumed uniform
/// over the chord of the contact (thesis App. B.2; moore_1999).

/// Returns the normal stress sigma = W/A and the shear stress tau = T/(r A) of a sample, with A = 2 b sqrt(2
/// r z - z^2) (thesis Eq. B.1). The result is input of MohrCoulombLine. The slip is not used, because the
/// shear strength is assumed to be fully mobilised. Throws std::invalid_argument unless 0 < sinkage < 2 r.
StressPair sojournerPair(const Wheel& wheel, const WheelSample& sample);

/// Linear-offset method of the thesis for cohesion c and friction angle phi: triangular stresses along the
/// rim plus a shear offset tau_offset = c B at the bottom of the wheel (thesis section 2.2). A and B are the
/// fractions of the shear strength that are mobilised at the stress peak and at the bottom
/// (LinearStressMoments).

/// Coefficients of the equation M1 c tan(phi) + c + M3 tan(phi) = M4 of one sample (thesis Eqs. 2.9, 2.10; M2
/// = 1).
struct LinearOffsetCoefficients {
  double m1 = 0.0;     ///< M1 [-]
  double m3_Pa = 0.0;  ///< M3
  double m4_Pa = 0.0;  ///< M4

  /// Returns the simplified equation c + M3 tan(phi) = M4 (thesis Eq. 2.11), the input of MohrCoulombLine.
  StressPair pair() const { return {.normal_Pa = m3_Pa, .shear_Pa = m4_Pa}; }
};

/// Returns M1, M3 and M4 of a sample for a given shear modulus K. Throws std::invalid_argument unless 0 <
/// sinkage < 2 r and K > 0, and std::domain_error if no shear is mobilised.
LinearOffsetCoefficients linearOffset(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m);

}  // namespace talus::terramech
