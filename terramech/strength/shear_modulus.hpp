#pragma once

#include <span>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/contact/wheel.hpp>
#include <talus/terramech/contact/wheel_sample.hpp>
#include <talus/terramech/strength/mohr_coulomb_line.hpp>

/// The shear deformation modulus K from wheel readings (thesis App. D). What each is worth, measured over
/// Table 2.1: the minimum of D.1 lies low (0.8 K noise-free, 0.65 K at 5 % noise); D.8 as printed gives 0.5
/// to 0.6 K. Once its watch is stopped a search ends with a K that means nothing.
namespace talus::terramech {

/// Where K is looked for [m].
struct ModulusRange {
  double low_m = 0.002;
  double high_m = 0.1;
};

/// K and the criterion at it.
struct ModulusEstimate {
  double shear_modulus_m = 0.0;
  /// Of the criterion: [Pa] for D.1, relative torque [-] for the joint fit, [m] spread for D.8.
  double error = 0.0;
  bool at_bound = false;  ///< the data do not see K: the criterion has no minimum inside the range
};

/// Err(K_e) = sum of the distances of the points (M3, M4) from the line fitted to them [Pa] (thesis Eq. D.2).
double modulusError_Pa(const Wheel& wheel, std::span<const WheelSample> samples, double shear_modulus_m);

/// The K_e of least Err(K_e), globally in the range (thesis App. D.1). Throws std::domain_error with fewer
/// than three samples.
ModulusEstimate modulusByErrorMinimisation(const Wheel& wheel, std::span<const WheelSample> samples,
                                           ModulusRange range = {}, const ProgressMonitor& watch = {});

/// K = -j(theta_m) / ln(1 - T/T_m), the median over the samples; T_m is the torque at the highest slip
/// (thesis Eq. D.8, as printed; T and T_m per unit of load, since loads differ). Low: it takes A(i_max)
/// for 1. Throws std::domain_error when no sample slips less and pulls less torque than the one at the
/// highest slip.
ModulusEstimate modulusByEffectiveTorque(const Wheel& wheel, std::span<const WheelSample> samples);

/// The same with A(i; K)/A(i_max; K) = T/T_m solved for K in each sample (ours: D.8 without setting A(i_max)
/// to 1).
ModulusEstimate modulusByTorqueRatio(const Wheel& wheel, std::span<const WheelSample> samples,
                                     ModulusRange range = {});

/// K, c and phi together: the K at which c + M3 tan(phi) = M4, fitted in relative torque, leaves least
/// (ours). Each equation is multiplied back to the torque it came from, so a small K gains nothing by
/// shrinking M3 and M4.
ModulusEstimate modulusJointly(const Wheel& wheel, std::span<const WheelSample> samples,
                               ModulusRange range = {}, const ProgressMonitor& watch = {});

}  // namespace talus::terramech
