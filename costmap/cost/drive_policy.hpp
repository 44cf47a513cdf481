#pragma once

#include <talus/common/constants.hpp>

namespace talus::costmap {

/// What a mission allows and what its cost weighs. Plain data.
struct DrivePolicy {
  bool allow_marginal = true;    ///< drive ground whose category at the slope along the heading is marginal
  bool allow_dangerous = false;  ///< drive dangerous ground too, as long as the soil can give the pull
  /// Drive over cells without elevation, as ground of the default class that is flat, or slopes as the nearest heights to both
  /// sides do (unseenSlope()); refused where that is too steep.
  bool allow_unknown = false;

  double slope_margin_rad = 5.0 * kDegree;  ///< category edges: tan(slope -+ margin), thesis 3.5: 5 deg
  double sinkage_threshold = 0.5;  ///< sinkage over radius below which the category stays, thesis 3.5 [-]
  /// Above which ground is dangerous [-]; 0: the rover's clearance over wheel radius.
  double sinkage_critical = 0.0;
  /// Refuse where the soil's pull falls short of the demand with more than this P [-].
  double max_immobilisation = 0.5;

  double pose_error_m =
      0.0;  ///< the rover's middle may be so far from where its route has it: soil is judged that much wider

  double time_weight_W = 1.0;  ///< joules that one second is worth
  double entrapment =
      0.01;  ///< share of the places where the ground pulls less than required that hold for good a rover
             ///< that watches its slip: mostly it notices and backs out (ours, not from the literature) [-]
  double unmonitored_entrapment = 1.0;  ///< the same of a rover that does not [-]
  bool unmonitored = false;             ///< nobody watches the slip on this drive
  double risk_weight_J = 1e8;           ///< joules that the loss of the rover is worth
  double correlation_length_m = 5.0;    ///< over which the soil of one class stays alike

  /// Share of the too weak places that hold the rover for good on this drive.
  double held() const noexcept { return unmonitored ? unmonitored_entrapment : entrapment; }
};

}  // namespace talus::costmap
