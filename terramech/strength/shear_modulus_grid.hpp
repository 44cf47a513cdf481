#pragma once

#include <array>

#include <talus/terramech/strength/linear_offset.hpp>
#include <talus/terramech/strength/shear_modulus.hpp>

namespace talus::terramech {

/// How K is found (thesis App. D): see shear_modulus.hpp.
enum class ModulusCriterion {
  Joint,              ///< least relative error of the torque
  ErrorMinimisation,  ///< D.1, by root mean square of the distances from the line
  EffectiveTorque,    ///< D.8 as printed, least squares over the samples in place of their median
  TorqueRatio         ///< T/W = tau A(i; K), tau and K by least squares: D.8 without setting A(i_max) to 1
};

/// A linear method: the equation it makes of a sample at a K [m].
using PairOf = StressPair (*)(const Wheel&, const WheelSample&, double);

/// c + M3 tan(phi) = M4 of linear_offset.hpp.
inline StressPair linearOffsetPair(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m) {
  return linearOffset(wheel, sample, shear_modulus_m).pair();
}

/// K, c and tan(phi) taken in sample by sample: for each K of a fixed ladder the sums that a criterion and a
/// linear method need, so memory and time are constant. A value type; const is thread-safe.
class ShearModulusGrid {
 public:
  struct Options {
    ModulusCriterion criterion = ModulusCriterion::Joint;
    PairOf pair = linearOffsetPair;
    ModulusRange range = {};
  };

  explicit ShearModulusGrid(const Wheel& wheel) : ShearModulusGrid(wheel, Options{}) {}
  ShearModulusGrid(const Wheel& wheel, const Options& options);

  /// Samples whose equation has no solution (nothing mobilised) are left out and counted by the caller:
  /// returns false.
  bool add(const WheelSample& sample);

  /// K at the lowest error, refined by a parabola through three rungs. Throws std::domain_error below four
  /// samples.
  ModulusEstimate modulus() const;

  /// The method's line at that K, between the two rungs next to it. Throws as modulus() and
  /// MohrCoulombLine::estimate() do.
  ShearStrength strength() const;

  std::size_t samples() const { return count_; }

 private:
  static constexpr std::size_t kValues = 17;  // 28 % apart: finer is slower and, by the parabola, no better

  struct GridValue {
    double modulus_m = 0.0;      // K
    MohrCoulombLine method;      // c + x tan(phi) = y
    MohrCoulombLine telling;     // linear-offset: weighted for Joint, plain for ErrorMinimisation
    double torque_share = 0.0;   // sum of T/W A
    double share_squares = 0.0;  // sum of A^2
    double share_fastest = 0.0;  // A at the highest slip so far
  };

  double squaredError(const GridValue& rung) const;

  // A place on the ladder: the lowest rung and how far the minimum lies from it, in rungs.
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
  double fastest_torque_ = 0.0;  // T/W there
};

}  // namespace talus::terramech
