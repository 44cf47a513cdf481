#include <algorithm>
#include <cmath>

#include <talus/costmap/telemetry/danger_watch.hpp>

namespace talus::costmap {
namespace {

constexpr double kLastSlip = 0.8;  // of the cost curves
constexpr double kStanding = 0.9;  // from which a wheel may as well not move
constexpr double kDoubt = 0.05;    // of DP/W by one slip and slope: two standard deviations
constexpr double kSunk = 0.75;     // of the radius
constexpr double kBelow = 0.01;    // of DP/W: the step in which evidence is kept
constexpr double kMost = 10.0;     // of either bound: beyond it nothing changes
constexpr double kFarBelow = 2.0;  // standard deviations

// The greater of what the slip sensor and the speeds say; NaN where neither says anything.
double slipOf(const TelemetryReading& reading) noexcept {
  const double most = std::fmax(reading.slip, reading.speed_slip);
  return most > 1.0 ? 1.0 : most;
}

// Within what the journal takes; NaN stays.
double kept(double most_pull) noexcept {
  return std::isnan(most_pull) ? most_pull : std::clamp(most_pull, -kMost, kMost);
}

}  // namespace

// DP/W that is dangerous at a gradient, whatever the rounding.
double DangerWatch::dangerousBelow(double gradient) const noexcept {
  return std::tan(std::atan(gradient) - model_.parts().policy.slope_margin_rad) - kBelow;
}

// The same for all that the rover may be driven down.
double DangerWatch::neverDriven() const noexcept {
  return dangerousBelow(-std::tan(model_.rover().max_pitch_rad));
}

GroundBound DangerWatch::hear(int class_index, const TelemetryReading& reading, double least_gradient) const {
  GroundBound bound;
  const double slip = slipOf(reading), z = reading.sinkage_m / model_.rover().wheel.radius_m;
  if (slip >= kDangerSlip) {
    const double at = model_.steady(class_index, {.slip = slip, .in_rut = reading.pass > 1}).gradient;
    bound.lower(model_.prior(class_index).pull.value + least_gradient - at + kDoubt);
  }
  const bool torque_limit = std::abs(reading.torque_Nm) >= model_.rover().max_torque_Nm;
  if (slip >= kLastSlip || torque_limit) bound.lower(dangerousBelow(least_gradient));
  if (z >= model_.parts().policy.sinkage_threshold) bound.least_sinkage = std::min(z, kMost);
  if (slip >= kStanding || z >= kSunk) bound.lower(neverDriven());
  bound.most_pull = kept(bound.most_pull);
  return bound;
}

GroundBound DangerWatch::hear(int class_index, const WheelObservation& suspected) const {
  GroundBound bound;
  const double class_std = model_.parts().classes[static_cast<std::size_t>(class_index)].pull_std;
  const double below = model_.prior(class_index).pull.value - suspected.pull.value;
  if (below > kFarBelow * std::hypot(suspected.pull.std, class_std)) bound.lower(kept(suspected.pull.value));
  return bound;
}

}  // namespace talus::costmap
