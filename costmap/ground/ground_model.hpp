#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <talus/costmap/cost/expected_travel.hpp>
#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/costmap/cost/travel_policy.hpp>
#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/effects.hpp>
#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/mobility/mobility.hpp>
#include <talus/terramech/numerics/estimate.hpp>

namespace talus::costmap {

/// Prior of a terrain class for the ground of its cells. Plain data.
struct GroundClass {
  int number = 0;                            ///< number in the terrain-class raster
  terramech::Soil soil;                      ///< mean soil
  std::vector<terramech::Effect> effects{};  ///< effects found in data, beyond a rigid wheel on the soil
  double pull_std = 0.05;                    ///< standard deviation of DP/W between places of the class [-]
  double mean_std = 0.05;                    ///< standard deviation of the class mean of DP/W [-]
  double sinkage_std = 0.1;                  ///< standard deviation of z/r between places [-]
};

/// Mobility curve of a rover on ground of a class. Throws std::invalid_argument as MobilityCurve.
terramech::MobilityCurve mobilityOf(const GroundClass& ground, const terramech::Rover& rover,
                                    const terramech::MobilityOptions& options = {});

/// Returns mobilityOf().reference() without the other points of the curve, a hundred times as fast.
terramech::MobilityReference referenceOf(const GroundClass& ground, const terramech::Rover& rover,
                                         const terramech::MobilityOptions& options = {});

/// Estimated strength of ground, at the reference slip 0.5.
struct GroundBelief {
  Estimate pull;     ///< drawbar pull divided by load, DP/W [-]
  Estimate sinkage;  ///< sinkage divided by wheel radius, z/r [-]
};

/// State of a driven wheel on fresh ground or in the rut of an equal wheel.
struct SlippingWheel {
  double slip = 0.0;
  bool in_rut = false;
  double slip_angle_rad = 0.0;  ///< limited to 60 degrees
};

/// Quantities of a wheel at constant speed.
struct SteadyWheel {
  double gradient = 0.0;  ///< gradient of the slope, equal to DP/W [-]
  double sinkage_over_radius = 0.0;
  double torque_over_load_radius = 0.0;
  double hold = 0.0;  ///< side force that resists sideways motion, divided by load [-]
};

/// A category and its probability.
struct RankedCategory {
  terramech::Category category = terramech::Category::Unknown;
  double probability = 0.0;
};

/// Ground model of one rover on one body: the mobility curve of each class, and the cost of ground for any
/// estimated strength. At the reference slip, a class has a thrust H (torque / (load * radius)),
/// a resistance R and a pull P = H - R, all divided by load. Driving on ground with an estimated pull P - d
/// at a gradient g equals driving on the class at the gradient
///   g + d                                  for g <= P - d (up to the reference slip): shift of the curve;
///   P + (g - P + d) / f,  f = 1 - d / H    beyond: the ground has the fraction f of the class's thrust
/// (ours; both are exact at the reference slip. For soils drawn from the deviations of mars_crusty,
/// sandy_loam and dry_sand, the shift overestimates the pull at slip 0.8 by 0.02, 0.04, 0.01 on average, and
/// the fraction by 0.00, 0.01, 0.00. Below the reference slip, the shift underestimates the pull.) The
/// standard deviation of the demand is that of the pull times the derivative of the demand by P - d. Ground
/// with a greater pull is driven like a flatter slope of the class, but no flatter than level ground, and has
/// no more reserve than its class. Cost and risk never decrease with the standard deviation nor, from level
/// ground upwards, with the gradient (ExpectedTravel). Downhill, the braking force over load on ground weaker
/// by d is less by d or by the fraction f, so that weaker ground is never allowed where stronger ground is
/// refused. CrossSlope adds the effect of cross slopes.
///
/// Curves and cross slopes of a class are computed once, at the first use: a class raster may declare
/// hundreds of classes, of which few occur in a window. Logically immutable and thread-safe; copies share the
/// computed classes.
class GroundModel {
 public:
  /// Rover, classes and policy of the model.
  struct Parts {
    terramech::Rover rover;
    std::vector<GroundClass> classes;  ///< the first class is the default, for cells without a class
    TravelPolicy policy;
    bool prices_crossing = true;  ///< false: CrossSlope::alongOnly(), for comparison only; unsafe for driving
  };

  /// Throws std::invalid_argument if there is no class, if two classes have the same number, or if a field is
  /// out of range.
  explicit GroundModel(Parts parts);

  const Parts& parts() const noexcept { return parts_; }
  const terramech::Rover& rover() const noexcept { return parts_.rover; }

  /// Returns the index in parts().classes of a class number; -1 for an undeclared number.
  int classIndex(int number) const noexcept;

  /// Returns the estimate of a class before any evidence.
  const GroundBelief& prior(int class_index) const noexcept { return referenceOf(class_index).prior; }

  /// Quantities of a wheel that drives steadily at this slip on the soil of the class; slips are limited to
  /// the drivable range. The effect of a slip angle is computed for fresh ground, also in a rut.
  SteadyWheel steady(int class_index, const SlippingWheel& wheel) const;
  /// Quantities of a wheel that drives straight on a slope of this gradient (rise over run), limited to the
  /// drivable gradients.
  SteadyWheel onSlope(int class_index, double gradient, bool in_rut) const;
  /// Quantities of a wheel at the reference slip.
  SteadyWheel reference(int class_index, bool in_rut) const noexcept;

  /// Drive curve and states of ground of a class with an estimated strength.
  GroundCost ground(int class_index, const GroundBelief& belief) const {
    return ground(class_index, class_index, belief);
  }
  /// Returns the drive curve and states of ground that may have either class: each quantity is the less
  /// favourable of the two classes.
  GroundCost ground(int class_index, int other_class, const GroundBelief& belief) const;

  /// Effect of cross slopes on ground of a class.
  const std::shared_ptr<const CrossSlope>& crossing(int class_index) const;

  /// State at a gradient along the heading (rise over run) without cross slope, as tabulated by ground().
  TravelState state(int class_index, const GroundBelief& belief, double gradient) const;

  /// Returns the cost of one horizontal metre [J]; infinite if refused.
  double cost_J_per_m(const TravelState& state) const noexcept;

  /// Category of ground at a gradient along the heading, and its probability under the estimate.
  RankedCategory category(const GroundBelief& belief, double gradient) const;

  TravelCost::Limits limits() const;

 private:
  // Quantities computed at construction; Lazy contains those computed at the first use.
  struct Reference {
    terramech::MobilityReference fresh, in_rut;  // of one wheel
    GroundBelief prior;
  };
  struct ClassGround;
  struct Lazy;
  const Reference& referenceOf(int class_index) const noexcept {
    return references_[static_cast<std::size_t>(class_index)];
  }
  const ClassGround& groundOf(int class_index) const;
  ClassGround workedOut(const GroundClass& ground) const;

  // DP/W below which a slope is dangerous (low), and above which it is safe (high).
  struct Edges {
    double low, high;
  };
  Edges edges(double gradient) const noexcept;
  TurnCosts turns(int class_index, const TravelState& flat) const;
  double criticalSinkage() const noexcept;
  Estimate demand(int class_index, const Estimate& pull, double gradient) const noexcept;
  static double weakProbability(const ClassGround& ground, const Estimate& pull, double gradient) noexcept;
  static double unbrakedProbability(const ClassGround& ground, const Estimate& pull,
                                    double gradient) noexcept;
  // Required DP/W: the maximum when driven, the minimum when braked.
  struct Demand {
    double driven, braked;
  };
  Refusal refusal(const TravelState& state, double weak, const Demand& demand,
                  const ClassGround& ground) const noexcept;
  terramech::Category categoryAt(double pull, double sinkage, double gradient) const;

  Parts parts_;
  double tan_margin_ = 0.0;
  std::vector<Reference> references_;
  std::vector<std::shared_ptr<Lazy>> grounds_;
};

}  // namespace talus::costmap
