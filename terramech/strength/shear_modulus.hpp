#pragma once

#include <span>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

/// Shear deformation modulus K from wheel readings (thesis App. D). Mean ratio of estimate to true K over
/// thesis Table 2.1: 0.8 for D.1 without noise, 0.65 for D.1 with 5 % noise, 0.5 to 0.6 for D.8 as printed.
/// If the watch stops a search, the returned K is meaningless.
namespace talus::terramech {

/// Search range of K [m], 0 < low_m < high_m.
struct ModulusRange {
  double low_m = 0.002;
  double high_m = 0.1;
};

/// Estimate of K and the value of the criterion.
struct ModulusEstimate {
  double shear_modulus_m = 0.0;
  /// Criterion at K: [Pa] for D.1, relative torque [-] for the joint fit, median absolute deviation [m] for
  /// D.8.
  double error = 0.0;
  /// True: the criterion has no minimum inside the range, and the data do not determine K.
  bool at_bound = false;
};

/// Returns Err(K_e), the sum of the distances of the points (M3, M4) from the line fitted to them [Pa]
/// (thesis Eq. D.2).
double modulusError_Pa(const Wheel& wheel, std::span<const WheelSample> samples, double shear_modulus_m);

/// Returns the K_e of the global minimum of Err(K_e) in the range (thesis App. D.1). Throws std::domain_error
/// with fewer than three samples.
ModulusEstimate modulusByErrorMinimisation(const Wheel& wheel, std::span<const WheelSample> samples,
                                           ModulusRange range = {}, const ProgressMonitor& watch = {});

/// Returns K = -j(theta_m) / ln(1 - T/T_m), the median over the samples; T_m is the torque at the highest
/// slip (thesis Eq. D.8, as printed; T and T_m per unit of load, because loads differ). The result is too
/// low, because D.8 assumes A(i_max) = 1. Throws std::domain_error with fewer than two samples, or if no
/// sample has less slip and less torque than that at the highest slip.
ModulusEstimate modulusByEffectiveTorque(const Wheel& wheel, std::span<const WheelSample> samples);

/// Returns the median K over the samples, each from A(i; K)/A(i_max; K) = T/T_m (ours: D.8 without A(i_max) =
/// 1). Throws as modulusByEffectiveTorque().
ModulusEstimate modulusByTorqueRatio(const Wheel& wheel, std::span<const WheelSample> samples,
                                     ModulusRange range = {});

/// Returns the K at which the least-squares fit of c + M3 tan(phi) = M4 over c and tan(phi) has the smallest
/// error relative to the torque (ours). The relative error prevents a small K from reducing the error by
/// shrinking M3 and M4. Throws std::domain_error with fewer than four samples.
ModulusEstimate modulusJointly(const Wheel& wheel, std::span<const WheelSample> samples,
                               ModulusRange range = {}, const ProgressMonitor& watch = {});

}  // namespace talus::terramech
