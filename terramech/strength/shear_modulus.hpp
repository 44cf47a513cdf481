#pragma once

#include <span>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

/// Shear deformation modulus K from wheel readings (thesis App. D). The mean ratio of estimated to true K
/// over thesis Table 2.1 is 0.8 for method D.1 without noise, 0.65 for D.1 with 5 % noise, and 0.5 to 0.6 for
/// method D.8 as printed. If the watch stops a search, the returned K is meaningless. M3 and M4 are those of
/// linear_offset.hpp; A(i; K) is the fraction of the shear strength that is mobilised at the stress peak at
/// slip i.
namespace talus::terramech {

/// Range of K in which a method searches, 0 < low_m < high_m.
struct ModulusRange {
  double low_m = 0.002;
  double high_m = 0.1;
};

/// Estimated K, and the value of the minimised error criterion at this K.
struct ModulusEstimate {
  double shear_modulus_m = 0.0;  ///< estimated K
  /// Criterion at K: [Pa] for D.1, relative to the torque [-] for modulusJointly(), median absolute deviation
  /// [m] for D.8.
  double error = 0.0;
  /// True if the criterion has no minimum inside the range, i.e. if the data do not determine K.
  bool at_bound = false;
};

/// Returns the error criterion Err(K_e) of a trial value K_e = shear_modulus_m: the sum of the distances of
/// the points (M3, M4) from the line fitted to them [Pa] (thesis Eq. D.2).
double modulusError_Pa(const Wheel& wheel, std::span<const WheelSample> samples, double shear_modulus_m);

/// Returns the K_e at the global minimum of Err(K_e) in the range (method D.1 of the thesis). Throws
/// std::domain_error with fewer than three samples.
ModulusEstimate modulusByErrorMinimisation(const Wheel& wheel, std::span<const WheelSample> samples,
                                           ModulusRange range = {}, const ProgressMonitor& watch = {});

/// Returns the median over the samples of K = -j(theta_m) / ln(1 - T/T_m), where T_m is the torque at the
/// highest slip i_max (thesis Eq. D.8 as printed; T and T_m per unit of load, because loads differ). The
/// result is too low, because D.8 assumes A(i_max) = 1. Throws std::domain_error with fewer than two samples,
/// or if no sample has both less slip and less torque than the sample at the highest slip.
ModulusEstimate modulusByEffectiveTorque(const Wheel& wheel, std::span<const WheelSample> samples);

/// Returns the median over the samples of the K that satisfies A(i; K)/A(i_max; K) = T/T_m (ours: D.8 without
/// the assumption A(i_max) = 1). Throws the exceptions of modulusByEffectiveTorque().
ModulusEstimate modulusByTorqueRatio(const Wheel& wheel, std::span<const WheelSample> samples,
                                     ModulusRange range = {});

/// Returns the K at which the least-squares fit of c + M3 tan(phi) = M4 over c and tan(phi) has the smallest
/// error relative to the torque (ours). The error is relative, because a small K reduces M3 and M4 and
/// thereby the absolute error. Throws std::domain_error with fewer than four samples.
ModulusEstimate modulusJointly(const Wheel& wheel, std::span<const WheelSample> samples,
                               ModulusRange range = {}, const ProgressMonitor& watch = {});

}  // namespace talus::terramech
