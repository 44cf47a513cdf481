#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <talus/costmap/cost/drive_cost.hpp>
#include <talus/costmap/cost/drive_policy.hpp>
#include <talus/costmap/cost/expected_drive.hpp>
#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>
#include <talus/terramech/effects/effects.hpp>
#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/mobility/mobility.hpp>
#include <talus/terramech/numerics/estimate.hpp>

namespace talus::costmap {

/// A terrain class as a prior for the ground of its cells. Plain data.
struct GroundClass {
  int number = 0;        ///< in the terrain-class raster
  terramech::Soil soil;  ///< its mean soil
  std::vector<terramech::Effect>
      effects{};             ///< that data have shown of it, beyond a rigid wheel on that soil
  double pull_std = 0.05;    ///< how drawbar pull over load differs from place to place within the class [-]
  double mean_std = 0.05;    ///< how far the class as a whole may be off [-]
  double sinkage_std = 0.1;  ///< sinkage over radius, place to place [-]
};

/// What a slope asks of a rover on ground of a class. Throws std::invalid_argument as MobilityCurve does.
terramech::MobilityCurve mobilityOf(const GroundClass& ground, const terramech::Rover& rover,
                                    const terramech::MobilityOptions& options = {});

/// mobilityOf().reference() alone, a hundred times as fast.
terramech::MobilityReference referenceOf(const GroundClass& ground, const terramech::Rover& rover,
                                         const terramech::MobilityOptions& options = {});

/// What is believed of the strength of a piece of ground, both at the reference slip 0.5.
struct GroundBelief {
  Estimate pull;     ///< drawbar pull over load [-]
  Estimate sinkage;  ///< sinkage over wheel radius [-]
};

/// A wheel at a slip, on fresh ground or in the rut of an equal one, that travels at an angle to its plane.
struct DrivenWheel {
  double slip = 0.0;
  bool in_rut = false;
  double slip_angle_rad = 0.0;  ///< more than 60 deg counts as that
};

/// Of a wheel that drives steadily.
struct SteadyWheel {
  double gradient = 0.0;  ///< of the slope it does so on, which is the drawbar pull over load it gives [-]
  double sinkage_over_radius = 0.0;
  double torque_over_load_radius = 0.0;
  double hold = 0.0;  ///< force across it, against its sideways motion, over load [-]
};

/// A category and the probability that it is that one.
struct Ranked {
  terramech::Category category = terramech::Category::Unknown;
  double probability = 0.0;
};

/// The ground of one rover on one body: per class the mobility curve of its soil, and from it what any belief
/// costs. At the reference slip the class has a thrust H (its torque over load and radius) against a resistance R: P = H - R.
/// Ground whose pull there is believed to be P - d drives on a gradient g as the class does
///   on g + d            up to the reference slip, where g <= P - d: the shift of the curve
///   on P + (g - P + d) / f,  f = 1 - d / H   beyond it: it has the share f of the class's thrust, and so of what more slip gives
/// (ours; at the reference slip both are exact. Of soils drawn from the deviations of mars_crusty, sandy_loam and dry_sand, pulls at slip
/// 0.8 that the shift takes 0.02, 0.04, 0.01 too high on average are 0.00, 0.01, 0.00 too high by the share; below the reference slip
/// the shift takes them too low). The standard deviation grows as the demand does with P - d. Ground that pulls more drives as on
/// a flatter slope, at most as on the level, and has no more reserve than its class. Cost and
/// risk never fall as a standard deviation grows, nor, from the level upwards, as the gradient grows
/// (ExpectedDrive). Downhill, ground that gives less by d brakes less by d, or its share, too, so that weaker ground is nowhere
/// allowed where stronger ground is refused. What crossing a slope costs is CrossSlope's to say. What takes long of a class, its
/// curves and what crossing slopes costs, is worked out when it is first asked for, once: a class raster may declare hundreds of
/// classes and a window hold three. Immutable to its callers; safe to share between threads, and so are copies.
class GroundModel {
 public:
  /// Everything the model is made from.
  struct Parts {
    terramech::Rover rover;
    std::vector<GroundClass> classes;  ///< the first is the default, for cells without a class
    DrivePolicy policy;
    bool prices_crossing =
        true;  ///< false: CrossSlope::alongOnly(), for comparison; no rover is to drive by it
  };

  /// Throws std::invalid_argument when there is no class, two share a number, or a field leaves its range.
  explicit GroundModel(Parts parts);

  const Parts& parts() const noexcept { return parts_; }
  const terramech::Rover& rover() const noexcept { return parts_.rover; }

  /// Position in parts().classes of a class number, or -1 when no soil is declared for it.
  int classIndex(int number) const noexcept;

  /// Belief before any evidence.
  const GroundBelief& prior(int class_index) const noexcept { return referenceOf(class_index).prior; }

  /// What a wheel of a rover that drives steadily at this slip on ground of the class reads, as its soil
  /// says; the ends of what it can drive beyond them. A slip angle changes it as it changes a wheel on fresh ground.
  SteadyWheel steady(int class_index, const DrivenWheel& wheel) const;
  /// The same of a wheel that drives straight on a slope of this gradient (rise over run), or on the nearest that its
  /// soil holds.
  SteadyWheel onSlope(int class_index, double gradient, bool in_rut) const;
  /// The same at the reference slip.
  SteadyWheel reference(int class_index, bool in_rut) const noexcept;

  /// Drive curve and states of ground of a class under a belief.
  DriveGround ground(int class_index, const GroundBelief& belief) const {
    return ground(class_index, class_index, belief);
  }
  /// The same of ground that may be of either class: the worse of both in everything.
  DriveGround ground(int class_index, int other_class, const GroundBelief& belief) const;

  /// What crossing slopes is worth on ground of a class.
  const std::shared_ptr<const CrossSlope>& crossing(int class_index) const;

  /// State at one gradient along the heading (rise over run) with none across, as ground() tabulates it.
  DriveState state(int class_index, const GroundBelief& belief, double gradient) const;

  /// Cost of one horizontal metre [J]; infinite when refused.
  double cost_J_per_m(const DriveState& state) const noexcept;

  /// Category of ground at a gradient along the heading, and its probability under the belief.
  Ranked category(const GroundBelief& belief, double gradient) const;

  DriveCost::Limits limits() const;

 private:
  // What is known of a class at once, and what is worked out when it is first asked for.
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

  // Drawbar pull over load at which a slope is no longer dangerous, and from which it is safe.
  struct Edges {
    double low, high;
  };
  Edges edges(double gradient) const noexcept;
  TurnPrices turns(int class_index, const DriveState& flat) const;
  double criticalSinkage() const noexcept;
  Estimate demand(int class_index, const Estimate& pull, double gradient) const noexcept;
  static double weakProbability(const ClassGround& ground, const Estimate& pull, double gradient) noexcept;
  static double unbrakedProbability(const ClassGround& ground, const Estimate& pull,
                                    double gradient) noexcept;
  // The pulls over load that the class must give: driven at most, braked at least.
  struct Demand {
    double driven, braked;
  };
  Refusal refusal(const DriveState& state, double weak, const Demand& demand,
                  const ClassGround& ground) const noexcept;
  terramech::Category categoryAt(double pull, double sinkage, double gradient) const;

  Parts parts_;
  double tan_margin_ = 0.0;
  std::vector<Reference> references_;
  std::vector<std::shared_ptr<Lazy>> grounds_;
};

}  // namespace talus::costmap
