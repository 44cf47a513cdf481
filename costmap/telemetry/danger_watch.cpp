#include <algorithm>
#include <cmath>

#include <talus/costmap/telemetry/danger_watch.hpp>

namespace talus::costmap {
namespace {

constexpr double kLastSlip = 0.8;  // slip at the end of the cost curves
constexpr double kStanding = 0.9;  // slip from which a wheel may be stationary
constexpr double kTwoStd = 0.05;   // two standard deviations of drawbar pull over load (DP/W) from one slip
                                   // and slope
constexpr double kSunk = 0.75;     // sinkage over radius from which ground is dangerous in every heading
constexpr double kBelow = 0.01;    // step in which evidence is stored, in DP/W
constexpr double kMost = 10.0;     // greatest value of either bound; greater values have no further effect
constexpr double kFarBelow = 2.0;  // standard deviations

// Returns the greater of the measured slip and the slip from speeds, at most 1; NaN if both are missing.
double slipOf(const TelemetryReading& reading) noexcept {
  const double most = std::fmax(reading.slip, reading.speed_slip);
  return most > 1.0 ? 1.0 : most;
}

// Limits a bound to the range of the journal; NaN stays.
double kept(double most_pull) noexcept {
  return std::isnan(most_pull) ? most_pull : std::clamp(most_pull, -kMost, kMost);
}

}  // namespace

// Returns the greatest DP/W that is dangerous at a gradient, less the step in which evidence is stored.
double DangerWatch::dangerousBelow(double gradient) const noexcept {
  return std::tan(std::atan(gradient) - model_.parts().policy.slope_margin_rad) - kBelow;
}

// Returns the greatest DP/W that is dangerous in every heading: the DP/W of the steepest descent that the
// rover may drive.
double DangerWatch::dangerousInEveryHeading() const noexcept {
  return dangerousBelow(-std::tan(model_.rover().max_pitch_rad));
}

GroundBound DangerWatch::bound(int class_index, const TelemetryReading& reading,
                               double least_gradient) const {
  GroundBound bound;
  const double slip = slipOf(reading), z = reading.sinkage_m / model_.rover().wheel.radius_m;
  if (slip >= kDangerSlip) {
    const double at = model_.steady(class_index, {.slip = slip, .in_rut = reading.pass > 1}).gradient;
    bound.lower(model_.prior(class_index).pull.value + least_gradient - at + kTwoStd);
  }
  const bool torque_limit = std::abs(reading.torque_Nm) >= model_.rover().max_torque_Nm;
  if (slip >= kLastSlip || torque_limit) bound.lower(dangerousBelow(least_gradient));
  if (z >= model_.parts().policy.sinkage_threshold) bound.least_sinkage = std::min(z, kMost);
  if (slip >= kStanding || z >= kSunk) bound.lower(dangerousInEveryHeading());
  bound.most_pull = kept(bound.most_pull);
  return bound;
}

GroundBound DangerWatch::bound(int class_index, const WheelObservation& suspected) const {
  GroundBound bound;
  const double class_std = model_.parts().classes[static_cast<std::size_t>(class_index)].pull_std;
  const double below = model_.prior(class_index).pull.value - suspected.pull.value;
  if (below > kFarBelow * std::hypot(suspected.pull.std, class_std)) bound.lower(kept(suspected.pull.value));
  return bound;
}

}  // namespace talus::costmap
