#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::costmap {

/// Steady motion of a rover at one pair of gradients, over the strength of the ground
/// (terramech::SlopeEquilibrium). The strengths of the entries exceed the least strength that holds by excess(k).
struct StrengthColumn {
  static constexpr int kStrengths = 12;
  static constexpr double kSpan = 3.0;  ///< excess of the last entry [-]
  enum Quantity { kEnergy, kTime, kSlip, kSinkage, kTorque, kSlipAngle, kSideForce, kQuantities };

  float least = 0.0F;  ///< least strength at which slip and slip angle stay within their limits
  /// The same whether later axles roll in ruts or on fresh ground: the strength that a decision requires, because
  /// the law of ruts is uncertain and a wheel may leave its rut.
  float required = 0.0F;
  float margin_rad = 0.0F;  ///< stability margin on ground of the class; NaN: not known
  /// Energy [J/m] and time [s/m] along the surface, slip, sinkage [m] and torque [N m] of the wheel with the
  /// greatest value, slip angle [rad] (negative where the ground rises to the left), side force over load.
  std::array<std::array<float, kStrengths>, kQuantities> entries{};

  /// Returns the excess over `least` of an entry: kSpan (k/11)^2.
  static constexpr double excess(int k) noexcept {
    const double share = static_cast<double>(k) / (kStrengths - 1);
    return kSpan * share * share;
  }
  /// Returns a quantity at an excess over `least`: linear between entries, constant beyond.
  double at(Quantity quantity, double excess) const noexcept;
};

/// Lattice T[strength][gradient along][gradient across] of the steady motion of one rover on the ground of one
/// class (ours), the one source of slip, slip angle, sinkage, torque, energy, time, reserve and the reason of a
/// refusal. Equilibria are solved at gradients along and across in steps of 1/32, up to
/// the limits of pitch and roll, and interpolated linearly at equal excess of strength over the least that
/// holds; the least strength is interpolated linearly as well. It is convex but for its edges between reasons,
/// so that interpolation errs towards danger. A rover with different sides has its worse side downhill.
/// Immutable.
class SlopeLattice {
 public:
  /// `across` = false: gradients across have no effect (for comparison with planners that ignore them).
  SlopeLattice(const terramech::SlopeEquilibrium& equilibrium, const TravelCost::Limits& limits,
               bool across = true);

  /// Returns the number of rows; steeper gradients across use the last row.
  int rows() const noexcept { return static_cast<int>(nodes_.size()) / bins(); }
  /// Returns true if a bin is within the limit of pitch.
  bool contains(int bin) const noexcept { return bin >= first_ && bin <= last_; }
  /// Returns the node of a row and a bin that contains() includes.
  const StrengthColumn& node(int row, int bin) const noexcept { return nodes_[index(row, bin)]; }
  /// Returns the gradient of the straight climb that requires the same strength as a slope, at least the gradient
  /// along; 4 if any ground refuses the slope.
  double climb(const terramech::Gradient& gradient) const noexcept;
  /// Returns the maximum of climb() over all headings on a plane of this gradient; at least `gradient`.
  double steepest(double gradient) const noexcept;
  /// Returns climb() of the node of a row and a bin that contains() includes, where no side tips.
  double climbOf(int row, int bin) const noexcept { return static_cast<double>(climbs_[index(row, bin)]); }

 private:
  int bins() const noexcept { return last_ - first_ + 1; }
  void findClimbs();
  void findSteepest();
  std::size_t index(int row, int bin) const noexcept {
    return static_cast<std::size_t>(std::min(row, rows() - 1) * bins() + bin - first_);
  }

  int first_ = 0, last_ = 0;
  std::vector<StrengthColumn> nodes_;     // [row][bin]
  std::vector<float> climbs_, steepest_;  // of nodes; by gradient in steps of CellCode up to 1
};

}  // namespace talus::costmap
