#pragma once

#include <array>
#include <span>

#include <talus/common/common.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

namespace talus::terramech {

/// Shear deformation modulus K from wheel readings (thesis App. D). The mean ratio of estimated to true K over thesis
/// Table 2.1 without noise is 0.82 for D.1 and the joint fit, and 0.46 for D.8 as printed; symbols of the linear methods
/// are those of strength_lines.hpp. A(i; K) is the fraction of the shear strength that is mobilised at the stress peak at
/// slip i.

/// Range of K in which a method searches, 0 < low_m < high_m.
struct ModulusRange {
  double low_m = 0.002;
  double high_m = 0.1;
};

/// Estimated K, and the value of the minimised error criterion at this K.
struct ModulusEstimate {
  double shear_modulus_m = 0.0;  ///< estimated K
  /// Criterion at K: [Pa] for D.1, relative to the torque [-] for the others.
  double error = 0.0;
  /// True if the criterion has no minimum inside the range, i.e. if the data do not determine K.
  bool at_bound = false;
};

/// Error criterion that determines the shear modulus K (thesis App. D).
enum class ModulusCriterion {
  /// Least error of the line c + M3 tan(phi) = M4 relative to the torque (ours). The error is relative, because a small
  /// K reduces M3 and M4 and thereby the absolute error.
  Joint,
  ErrorMinimisation,  ///< least rms distance of the points (M3, M4) from the line fitted to them (thesis Eq. D.2)
  /// T/T_m = A(i; K) by least squares, with the torque T_m at the highest slip i_max (thesis Eq. D.8 as printed; T and
  /// T_m per unit of load, because loads differ). The result is too low, because D.8 assumes A(i_max) = 1.
  EffectiveTorque,
  /// T/W = tau A(i; K), with tau and K by least squares: D.8 without the assumption A(i_max) = 1.
  TorqueRatio
};

/// Linear method for c and tan(phi): function that returns the equation of a sample at a given K [m].
using PairOf = StressPair (*)(const Wheel&, const WheelSample&, double);

/// Returns the equation c + M3 tan(phi) = M4 of strength_lines.hpp for a sample.
inline StressPair linearOffsetPair(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m) {
  return linearOffset(wheel, sample, shear_modulus_m).pair();
}

/// Recursive estimate of K, c and tan(phi). For each K of a fixed grid the object stores the sums of the
/// criterion and of the linear method, so that memory and time per sample are constant. Copyable; const
/// members are thread-safe.
class ShearModulusGrid {
 public:
  /// Error criterion for K, linear method for c and tan(phi), and range of the grid of K.
  struct Options {
    ModulusCriterion criterion = ModulusCriterion::Joint;
    PairOf pair = linearOffsetPair;
    ModulusRange range = {};
  };

  explicit ShearModulusGrid(const Wheel& wheel) : ShearModulusGrid(wheel, Options{}) {}
  ShearModulusGrid(const Wheel& wheel, const Options& options);

  /// Adds a sample. Returns false and does not add the sample if torque or shear displacement is <= 0, i.e.
  /// if no shear is mobilised.
  bool add(const WheelSample& sample);

  /// Returns the K with the smallest error, refined by a parabola through three grid values. Throws
  /// std::domain_error with fewer than four samples.
  ModulusEstimate modulus() const;

  /// Returns c and tan(phi) of the linear method at the K of modulus(), interpolated between two grid values.
  /// Throws the exceptions of modulus() and MohrCoulombLine::estimate().
  ShearStrength strength() const;

  std::size_t samples() const { return count_; }

 private:
  // Adjacent values of K have the ratio 1.28. The minimum is interpolated by a parabola, so that a finer grid
  // takes longer without being more accurate.
  static constexpr std::size_t kValues = 17;

  /// Sums for one value of K.
  struct GridValue {
    double modulus_m = 0.0;  // K
    MohrCoulombLine method;  // line of the linear method, c + x tan(phi) = y
    // Line of the linear-offset criterion: weighted for Joint, unweighted for ErrorMinimisation.
    MohrCoulombLine line;
    double torque_share = 0.0;   // sum of (T/W) A
    double share_squares = 0.0;  // sum of A^2
    double share_fastest = 0.0;  // A at the highest slip so far
  };

  double squaredError(const GridValue& rung) const;

  // Location of the minimum: index of the grid value with the smallest error, and shift in grid steps.
  struct Place {
    std::size_t rung;
    double shift;  // [-0.5, 0.5]
  };
  Place best() const;
  void addTorque(const WheelSample& sample, double displacement_m);

  Wheel wheel_;
  Options options_;
  std::array<GridValue, kValues> values_;
  std::size_t count_ = 0;
  double torque_squares_ = 0.0;  // sum of (T/W)^2
  double fastest_slip_ = 0.0;
  double fastest_torque_ = 0.0;  // T/W at the highest slip
};

}  // namespace talus::terramech
