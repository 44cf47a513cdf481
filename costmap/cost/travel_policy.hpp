#pragma once

#include <talus/common/constants.hpp>

namespace talus::costmap {

/// Permissions and cost weights of a mission. Plain data. The categories of ground are safe, marginal and
/// dangerous.
struct TravelPolicy {
  /// True if ground is allowed whose category at the slope along the heading is marginal.
  bool allow_marginal = true;
  /// True if dangerous ground is allowed where the soil supports the required pull.
  bool allow_dangerous = false;
  /// True if cells without elevation are allowed, with the slope of unseenSlope(), as ground of their terrain
  /// class or, without a class, of the model's first class. Such a cell is refused if that slope is too
  /// steep.
  bool allow_unknown = false;

  /// Margin of the category limits, which are tan(slope -+ margin); thesis 3.5: 5 deg.
  double slope_margin_rad = 5.0 * kDegree;
  /// Greatest sinkage over wheel radius z/r that does not affect the category (thesis 3.5) [-].
  double sinkage_threshold = 0.5;
  /// z/r above which ground is dangerous [-]; 0: the clearance of the rover over the wheel radius is used.
  double sinkage_critical = 0.0;
  /// Greatest allowed probability that the drawbar pull is insufficient [-]; other ground is refused.
  double max_immobilisation = 0.5;

  /// Greatest position error of the rover, which enlarges the area whose soil is evaluated for a cell.
  double pose_error_m = 0.0;

  double time_weight_W = 1.0;  ///< weight of time [J/s]
  /// Probability that insufficient drawbar pull immobilises a rover with slip monitoring, which usually stops
  /// and backs out (ours, not from the literature) [-].
  double entrapment = 0.01;
  /// Probability that insufficient drawbar pull immobilises a rover without slip monitoring [-].
  double unmonitored_entrapment = 1.0;
  bool unmonitored = false;           ///< true if this drive has no slip monitoring
  double risk_weight_J = 1e8;         ///< cost of the loss of the rover [J]
  double correlation_length_m = 5.0;  ///< correlation length of the soil within one class

  /// Returns the probability that insufficient drawbar pull immobilises the rover on this drive [-].
  double held() const noexcept { return unmonitored ? unmonitored_entrapment : entrapment; }

  bool operator==(const TravelPolicy&) const = default;
};

}  // namespace talus::costmap
