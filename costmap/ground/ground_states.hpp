#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <vector>

#include <talus/costmap/cost/slope_lattice.hpp>
#include <talus/costmap/cost/travel_states.hpp>
#include <talus/costmap/ground/ground_category.hpp>

namespace talus::costmap {

/// Permissions, weights and limits of the rover by which ground is priced.
struct GroundRules {
  TravelPolicy policy;
  terramech::Rover rover;
  GroundCategory category{policy, rover};
};

/// A class to which ground may belong, and the strength of the ground relative to that class.
struct StrengthOfClass {
  std::shared_ptr<const SlopeLattice> lattice;
  int class_index = 0;
  Estimate strength;    ///< relative to the class [-]
  double deeper = 1.0;  ///< sinkage relative to the class [-]
};

/// Travel states of ground whose strength s is normally distributed. At a node of the lattice the motion holds for
/// s >= s_0, and a decision requires s >= s_d (StrengthColumn). With e(s) the energy and t(s) the time of a metre:
///   forecast   energy = E[e(s) | s >= s_0], time = E[t(s) | s >= s_0], slip, torque and sinkage at E[s];
///   decision   refused if E[s] < s_d, or if P(s < s_d) exceeds policy.max_immobilisation, and by category,
///              sinkage, torque and tipping;
///   cost       E[e(s); s >= s_0] + 2 e(s_0) P(s < s_0), the attempt at the limit and the way back (ours),
///              likewise for time, and risk_J times the hazard of immobilisation by P(s < s_d).
/// All integrals are exact, because e and t are linear between the entries of the lattice. Ground that may belong
/// to two classes has the worse value of each quantity. Costs are raised to those of rows with less gradient
/// across. Thread-safe.
class GroundStates final : public TravelStates {
 public:
  /// `classes` has one or two entries; `added_J_per_m` is added to the energy of each metre.
  GroundStates(std::shared_ptr<const GroundRules> rules, std::vector<StrengthOfClass> classes,
               const GroundBelief& belief, double added_J_per_m = 0.0);

  TravelState at(int row, int bin) const override;
  TravelCurve curve(const CostWeights& weights) const override;
  SlopeHold hold(const terramech::Gradient& gradient) const override;
  double climb(const terramech::Gradient& gradient) const override;
  double steepest(double gradient) const override;
  TravelForecast forecast(const terramech::Gradient& gradient) const override;

  /// Returns the state on a slope without gradient across, interpolated between nodes.
  TravelState onClimb(double gradient) const;
  std::shared_ptr<const TravelStates> withAdded(double added_J_per_m) const override;

 private:
  // Terms of the cost of a node; infinite if refused.
  struct Terms {
    double energy_J_per_m, time_s_per_m, risk_per_m;
  };
  struct Node {
    TravelState state;
    Terms terms;
  };
  class WeightTable;
  Node node(int row, int bin, const std::vector<WeightTable>* weights = nullptr) const;
  Node node(const StrengthOfClass& of, const WeightTable* weights, int row, int bin) const;
  std::vector<std::array<float, 3>> terms() const;
  bool isAllowed(std::size_t node) const;
  int rows() const noexcept;

  std::shared_ptr<const GroundRules> rules_;
  std::vector<StrengthOfClass> classes_;
  GroundBelief belief_;
  double added_J_per_m_;
  mutable std::once_flag once_;
  mutable std::vector<bool> allowed_;  // by node: neither this row nor one with less gradient across refuses
};

}  // namespace talus::costmap
