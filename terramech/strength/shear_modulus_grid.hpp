#pragma once

#include <array>

#include <talus/terramech/strength/linear_offset.hpp>
#include <talus/terramech/strength/shear_modulus.hpp>

namespace talus::terramech {

/// Criterion for K (thesis App. D); see shear_modulus.hpp.
enum class ModulusCriterion {
  Joint,              ///< smallest error relative to the torque
  ErrorMinimisation,  ///< D.1, by rms of the distances from the line
  EffectiveTorque,    ///< D.8 as printed, by least squares over the samples instead of their median
  TorqueRatio         ///< T/W = tau A(i; K), tau and K by least squares: D.8 without A(i_max) = 1
};

/// Linear method: returns the equation of a sample at a given K [m].
using PairOf = StressPair (*)(const Wheel&, const WheelSample&, double);

/// Returns c + M3 tan(phi) = M4 of linear_offset.hpp.
inline StressPair linearOffsetPair(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m) {
  return linearOffset(wheel, sample, shear_modulus_m).pair();
}

/// Recursive estimate of K, c and tan(phi). For each K of a fixed grid the object stores the sums for the
/// criterion and for the linear method, so that memory and time per sample are constant. Copyable; const
/// members are thread-safe.
class ShearModulusGrid {
 public:
  struct Options {
    ModulusCriterion criterion = ModulusCriterion::Joint;
    PairOf pair = linearOffsetPair;
    ModulusRange range = {};
  };

  explicit ShearModulusGrid(const Wheel& wheel) : ShearModulusGrid(wheel, Options{}) {}
  ShearModulusGrid(const Wheel& wheel, const Options& options);

  /// Adds a sample. Returns false, without adding, if torque or shear displacement is not above 0 (no shear
  /// mobilised).
  bool add(const WheelSample& sample);

  /// Returns the K of the smallest error, refined by a parabola through three grid values. Throws
  /// std::domain_error with fewer than four samples.
  ModulusEstimate modulus() const;

  /// Returns the line of the linear method at that K, interpolated between two grid values. Throws as
  /// modulus() and MohrCoulombLine::estimate().
  ShearStrength strength() const;

  std::size_t samples() const { return count_; }

 private:
  // 17 values have a spacing of 28 %; with the parabola, a finer grid is slower and no more accurate.
  static constexpr std::size_t kValues = 17;

  struct GridValue {
    double modulus_m = 0.0;  // K
    MohrCoulombLine method;  // line of the linear method, c + x tan(phi) = y
    // Line of the criterion, linear-offset: weighted for Joint, plain for ErrorMinimisation.
    MohrCoulombLine line;
    double torque_share = 0.0;   // sum of (T/W) A
    double share_squares = 0.0;  // sum of A^2
    double share_fastest = 0.0;  // A at the highest slip so far
  };

  double squaredError(const GridValue& rung) const;

  // Location of the minimum: grid value with the smallest error, and shift in grid steps.
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
