#pragma once

#include <talus/common/constants.hpp>

namespace talus::costmap {

/// Permissions and cost weights of a mission. Plain data.
struct TravelPolicy {
  bool allow_marginal = true;    ///< allow ground whose category at the slope along the heading is marginal
  bool allow_dangerous = false;  ///< allow dangerous ground if the soil supports the required pull
  /// Allow cells without elevation, as ground of the default class with the slope of unseenSlope(); refused
  /// if that slope is too steep.
  bool allow_unknown = false;

  double slope_margin_rad = 5.0 * kDegree;  ///< category limits at tan(slope -+ margin), thesis 3.5: 5 deg
  double sinkage_threshold = 0.5;           ///< sinkage over radius, z/r, without effect (thesis 3.5)
  /// z/r above which ground is dangerous [-]; 0: clearance of the rover divided by wheel radius.
  double sinkage_critical = 0.0;
  /// Refuse ground if the probability that the drawbar pull is insufficient exceeds this limit [-].
  double max_immobilisation = 0.5;

  double pose_error_m =
      0.0;  ///< greatest position error of the rover; enlarges the area whose soil is evaluated

  double time_weight_W = 1.0;  ///< weight of time [J/s]
  double entrapment =
      0.01;  ///< probability that insufficient drawbar pull immobilises a rover with slip monitoring, which
             ///< usually stops and backs out (ours, not from the literature) [-]
  double unmonitored_entrapment = 1.0;  ///< the same probability for a rover without slip monitoring [-]
  bool unmonitored = false;             ///< true if this drive has no slip monitoring
  double risk_weight_J = 1e8;           ///< cost of the loss of the rover [J]
  double correlation_length_m = 5.0;    ///< correlation length of the soil within one class

  /// Probability that insufficient drawbar pull immobilises the rover on this drive [-].
  double held() const noexcept { return unmonitored ? unmonitored_entrapment : entrapment; }
};

}  // namespace talus::costmap
