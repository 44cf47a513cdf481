#include <cmath>
#include <limits>

#include <costmap/wheel_observation.hpp>

namespace talus::costmap {
namespace {

constexpr double kReferenceSlip = 0.5;
// How far the shift of a curve at one slip misses that at the reference slip, per unit of slip: some, and
// more the further the ground departs from its class (ours; sand driven as if dust misses by a quarter of the
// departure at slip 0.3).
constexpr double kShiftPerSlip = 0.06;
constexpr double kShiftPerSlipAndDeparture = 1.2;

bool known(double value) noexcept {
  return std::isfinite(value);
}

// Two estimates of one number.
Estimate combined(const Estimate& a, const Estimate& b) noexcept {
  const double wa = 1.0 / (a.std * a.std), wb = 1.0 / (b.std * b.std);
  return {(wa * a.mean + wb * b.mean) / (wa + wb), 1.0 / std::sqrt(wa + wb)};
}

}  // namespace

double pullFromTorque(double torque_over_load_radius, double sinkage_over_radius) noexcept {
  const double entry = std::acos(1.0 - sinkage_over_radius);
  const double quarter = 0.25 * entry;
  const double sinc = quarter > 1e-9 ? std::sin(quarter) / quarter : 1.0;
  return sinc * sinc / std::cos(0.5 * entry) * torque_over_load_radius - std::tan(0.5 * entry);
}

WheelObserver::WheelObserver(const GroundModel& model, const ReadingNoise& noise)
    : model_(model), noise_(noise) {}

std::optional<WheelObservation> WheelObserver::observe(int class_index, const WheelReading& reading) const {
  const double radius_m = model_.rover().wheel.radius_m;
  if (!known(reading.slip) || !(reading.load_N > 0.0)) return std::nullopt;
  WheelObservation out{.time_s = reading.time_s,
                       .place = reading.place,
                       .pull = {},
                       .sinkage = {},
                       .demand = reading.gradient,
                       .from_torque = std::numeric_limits<double>::quiet_NaN()};
  const double z = reading.sinkage_m / radius_m;
  const double t = reading.torque_Nm / (radius_m * reading.load_N);
  if (known(t) && z >= 0.0 && z < 1.0) out.from_torque = pullFromTorque(t, z);

  Estimate pull{0.0, std::numeric_limits<double>::infinity()};
  if (known(reading.gradient)) pull = {reading.gradient, std::hypot(noise_.gradient, noise_.model_pull)};
  if (known(out.from_torque)) {
    const Estimate torque{out.from_torque,
                          std::hypot(noise_.torque_share * t, noise_.sinkage_share, noise_.model_pull)};
    pull = known(reading.gradient) ? combined(pull, torque) : torque;
  }
  if (known(reading.drawbar_pull_N)) pull = {reading.drawbar_pull_N / reading.load_N, noise_.model_pull};
  if (!known(pull.std)) return std::nullopt;

  const GroundBelief prior = model_.prior(class_index);
  const double expected = model_.gradientAtSlip(class_index, reading.slip);
  const double steepness = (model_.gradientAtSlip(class_index, reading.slip + noise_.slip) -
                            model_.gradientAtSlip(class_index, reading.slip - noise_.slip)) /
                           2.0;
  const double extrapolation = std::abs(reading.slip - kReferenceSlip) *
                               (kShiftPerSlip + kShiftPerSlipAndDeparture * std::abs(pull.mean - expected));
  out.pull = {prior.pull.mean + pull.mean - expected, std::hypot(pull.std, steepness, extrapolation)};
  out.sinkage = {prior.sinkage.mean, std::numeric_limits<double>::infinity()};
  if (z >= 0.0 && z < 1.0) {
    const double modelled = model_.sinkageAtSlip(class_index, reading.slip) / radius_m;
    if (modelled > 0.0)
      out.sinkage = {prior.sinkage.mean * z / modelled, noise_.sinkage_share * prior.sinkage.mean / modelled};
  }
  return out;
}

}  // namespace talus::costmap
