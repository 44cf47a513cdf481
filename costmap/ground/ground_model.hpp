#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/effects/refined_model.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

namespace talus::costmap {

using terramech::Estimate;
using terramech::SteadyWheel;

/// Estimated strength of ground: quantities of a wheel at the reference slip 0.5, each with standard
/// deviation.
struct GroundBelief {
  Estimate pull;     ///< drawbar pull over load, DP/W [-]
  Estimate sinkage;  ///< sinkage over wheel radius, z/r [-]
};

/// A category and its probability.
struct RankedCategory {
  terramech::Category category = terramech::Category::Unknown;
  double probability = 0.0;
};

/// Category of a cell and the probability of the category.
struct CellCategory {
  std::uint8_t category;  ///< terramech::Category as a number
  /// Probability in steps of 1/16, rounded to nearest if dangerous and down otherwise.
  std::uint8_t confidence;
};

/// Permissions, weights and limits of the rover by which ground is priced.
struct GroundRules {
  TravelPolicy policy;
  terramech::Rover rover;
  double tan_margin = std::tan(policy.slope_margin_rad);

  /// Returns the limits of the categories of ground at a gradient, by its pull against the slope and by its
  /// sinkage (thesis 3.5).
  terramech::CategoryThresholds thresholds(double gradient) const noexcept;
  /// Returns the category of ground with the mean strength of `belief` at a gradient.
  terramech::Category category(const GroundBelief& belief, double gradient) const;
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
  double climb(const terramech::Gradient& gradient) const override;
  double steepest(double gradient) const override;
  TravelForecast forecast(const terramech::Gradient& gradient) const override;

  std::shared_ptr<const TravelStates> withAdded(double added_J_per_m) const override;

 private:
  struct Node {
    TravelState state;
    std::array<double, 3> terms;  // of the cost
  };
  Node node(int row, int bin) const;
  Node node(const StrengthOfClass& of, int row, int bin) const;
  std::vector<Terms> terms() const override;
  bool isAllowed(std::size_t node) const;
  int rows() const noexcept;

  std::shared_ptr<const GroundRules> rules_;
  std::vector<StrengthOfClass> classes_;
  GroundBelief belief_;
  double added_J_per_m_;
  mutable std::once_flag once_;
  mutable std::vector<bool> allowed_;  // by node: neither this row nor one with less gradient across refuses
};

/// A terrain class: the prior for the strength of the ground of its cells. Plain data.
struct GroundClass {
  int number = 0;        ///< number of the class in the terrain-class raster
  terramech::Soil soil;  ///< mean soil of the class
  /// Effects found in wheel data, in addition to the model of a rigid wheel on the soil.
  std::vector<terramech::Effect> effects{};
  /// Standard deviation of the drawbar pull over load DP/W between places of the class, at slip 0.5 [-].
  double pull_std = 0.05;
  double mean_std = 0.05;  ///< standard deviation of the mean DP/W of the class [-]
  /// Standard deviation of the mean resistance (thrust less pull) over load at slip 0.5 [-].
  double resistance_std = 0.02;
  double modulus_std = 0.2;  ///< standard deviation of the logarithm of the shear modulus [-]
  /// Standard deviation of the pull over load in ruts that is not of strength, resistance and shear modulus [-].
  double rut_std = 0.0;
  double sinkage_std = 0.1;  ///< standard deviation of sinkage over wheel radius z/r between places [-]
  double rut_stiffness_std =
      0.0;  ///< standard deviation of Soil::rut_stiffness, drawn in simulated worlds [-]
};

/// Returns the wheel model of a class.
terramech::RefinedModel modelOf(const GroundClass& ground);

/// State of a driven wheel.
struct SlippingWheel {
  /// Slip [-].
  double slip = 0.0;
  /// True if the wheel runs in the rut of an equal wheel; false on undisturbed ground.
  bool in_rut = false;
  /// Angle from the wheel plane to the direction of travel, left positive; limited to 60 degrees.
  double slip_angle_rad = 0.0;
};

/// Travel states that are stated, not computed from a rover and soils. The rover is a point, the cost is the energy,
/// and turning is free.
struct StatedCosts {
  std::vector<std::shared_ptr<const TravelStates>> states;  ///< of each class, by class index
  double max_along = 1.0, max_across = 2.0;                 ///< greatest gradients, rise over run [-]
};

/// Ground model of one rover on one body: the lattice of equilibria of each terrain class, and the cost of
/// driving for any estimated strength of the ground. At the reference slip, a class has a thrust H = torque /
/// (load * radius), a resistance R and a pull P = H - R, all over load. Ground with the estimated pull P - d has
/// the strength s = 1 - d / H: s times the shear stresses of its class, and its resistance
/// (terramech::SlopeEquilibrium; ours, exact at the reference slip. For soils drawn from the standard deviations
/// of mars_crusty, sandy_loam and dry_sand, it overestimates the pull at slip 0.8 by 0.00, 0.01, 0.00 on average).
/// GroundStates has the forecast, the decision and the cost.
///
/// Lattices of a class are computed at the first use, because a class raster may declare hundreds of classes, of
/// which few occur in a window. Logically immutable and thread-safe; copies share the computed classes.
class GroundModel {
 public:
  /// Input of the model.
  struct Parts {
    terramech::Rover rover;
    /// Terrain classes. The first class applies to maps without a class raster, and to cells
    /// without a class if the policy allows unknown ground.
    std::vector<GroundClass> classes;
    /// Permissions and cost weights of the mission.
    TravelPolicy policy;
    /// True if slopes across the heading add cost. False: they have no effect, for comparison only;
    /// unsafe for driving.
    bool prices_crossing = true;
    std::optional<StatedCosts> stated{};  ///< costs in place of those of rover and soils
  };

  /// Throws std::invalid_argument if there is no terrain class, if two classes have the same number, or if a
  /// field is out of range.
  explicit GroundModel(Parts parts);

  const Parts& parts() const noexcept { return parts_; }
  const terramech::Rover& rover() const noexcept { return parts_.rover; }

  /// Returns the index in parts().classes of the class with this number; -1 for a number without a class.
  int classIndex(int number) const noexcept;

  /// Returns the estimated strength of a class before any evidence from wheels.
  const GroundBelief& prior(int class_index) const noexcept { return of(class_index).prior; }

  /// Returns the quantities of a wheel that drives at constant slip on the soil of the class. The slip is
  /// limited to that of the greatest pull.
  SteadyWheel steady(int class_index, const SlippingWheel& wheel) const;
  /// Returns the quantities of a wheel that drives straight up a slope of this gradient (rise over run),
  /// limited to the drivable gradients.
  SteadyWheel onSlope(int class_index, double gradient, bool in_rut) const;
  /// Returns the quantities of a wheel at the reference slip 0.5.
  const SteadyWheel& reference(int class_index, bool in_rut) const noexcept {
    return of(class_index).reference[in_rut ? 1 : 0];
  }

  /// Returns a model of one class alone, with its resistance changed by a number of standard deviations
  /// (GroundClass::resistance_std) through the sinkage exponent, which is kept from 0.3 to 2.
  std::shared_ptr<const GroundModel> withResistance(int class_index, double deviations) const;

  /// Returns the weights of the cost by the policy.
  CostWeights weights() const noexcept;
  /// Returns the cost curve and the travel states of ground that belongs to a class and has the estimated strength
  /// `belief`. If it may also belong to `other_class` (-1: none), each quantity is the less favourable one of
  /// both classes.
  GroundCost ground(int class_index, const GroundBelief& belief, int other_class = -1) const;

  /// Returns the lattice of equilibria of a class.
  const std::shared_ptr<const SlopeLattice>& lattice(int class_index) const;

  /// Returns the travel state on a gradient along the heading (rise over run) without cross slope.
  TravelState state(int class_index, const GroundBelief& belief, double gradient) const {
    return states(class_index, belief)->state({.along = gradient});
  }

  /// Returns the category of ground with the mean strength of `belief` at a gradient along the heading, and
  /// the probability of that category under the uncertainty of `belief`.
  RankedCategory category(const GroundBelief& belief, double gradient) const {
    if (parts_.stated) return {terramech::Category::Safe, 1.0};
    const terramech::Category mean = rules_->category(belief, gradient);
    return {mean,
            terramech::categoryProbability({belief.pull, belief.sinkage},
                                           rules_->thresholds(gradient))[static_cast<std::size_t>(mean)]};
  }

  /// Returns the limits of pitch and roll as gradients, and the tipping geometry of the rover.
  TravelCost::Limits limits() const;

 private:
  // A class: its references on fresh ground and in a rut, and what is computed at the first use.
  struct Ground {
    std::array<SteadyWheel, 2> reference;
    GroundBelief prior;
    std::once_flag once, solved;
    std::optional<terramech::SlopeEquilibrium> slope;
    std::array<double, 2> most_slip{};  // least slip at a maximum of the pull, on fresh ground and in a rut
    std::shared_ptr<const SlopeLattice> lattice;
    std::mutex changing;
    std::map<double, std::shared_ptr<const GroundModel>> with_resistance;
  };
  Ground& of(int class_index) const noexcept { return *grounds_[static_cast<std::size_t>(class_index)]; }
  const terramech::SlopeEquilibrium& slope(int class_index) const;
  std::shared_ptr<const GroundStates> states(int class_index, const GroundBelief& belief,
                                             int other_class = -1) const;
  StrengthOfClass strengthOf(int class_index, const GroundBelief& belief) const;
  terramech::TurnEfforts turns(int class_index,
                               const TravelState& flat) const;  // `flat`: state on level ground

  Parts parts_;
  std::shared_ptr<const GroundRules> rules_;
  std::vector<std::shared_ptr<Ground>> grounds_;
};

/// Returns the terrain class number `number` for a soil prior and a rover. GroundClass::mean_std is the
/// standard deviation of drawbar pull over load DP/W at the reference slip 0.5, by central differences over
/// the standard deviations of cohesion, friction angle, sinkage exponent, moduli, shear modulus and
/// slip-sinkage exponent as independent parameters; a prior without standard deviations keeps GroundClass's
/// default. resistance_std, modulus_std and rut_std are obtained likewise, at least the defaults. A soil that was
/// tested in greater gravity is converted by underGravity(); mean_std then includes
/// the effect of a gravity exponent of 0.5 instead of 1. Throws std::invalid_argument if
/// mobilityReference() rejects the soil or the rover.
GroundClass groundClass(int number, const terramech::SoilPrior& prior, const terramech::Rover& rover);

/// Returns the terrain class number `number` for a refined model (soil and effects fitted to wheel data) and
/// a rover. mean_std is the standard deviation of DP/W at the reference slip by the model's covariance; a
/// model without a covariance keeps GroundClass's default. Sensor effects are omitted. Gravity is converted
/// as for a soil prior. Throws std::invalid_argument if mobilityReference()
/// rejects the soil or the rover.
GroundClass groundClass(int number, const terramech::RefinedModel& model, const terramech::Rover& rover);

}  // namespace talus::costmap
