#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <talus/costmap/evidence/evidence.hpp>

namespace talus::costmap {

namespace {

// Limits beyond any wheel: pull over load and sinkage over radius of 100.
constexpr double kGreatestShare = 100.0;
constexpr double kGreatestPlace_m = 1e9;

std::string outside(const char* name, double value, double bound) {
  if (std::abs(value) <= bound) return "";
  return std::string(name) + " = " + std::to_string(value) + ", must be finite and within " +
         std::to_string(static_cast<std::int64_t>(bound));
}

}  // namespace

std::string fault(const WheelObservation& o) {
  const bool bounds_alone = o.here.any() && std::isnan(o.pull.value) && std::isnan(o.pull.std) &&
                            std::isnan(o.sinkage.value) && std::isnan(o.sinkage.std);
  if (!bounds_alone)
    for (const std::string& reason :
         {outside("pull", o.pull.value, kGreatestShare), outside("pull_std", o.pull.std, kGreatestShare),
          outside("sinkage", o.sinkage.value, kGreatestShare)})
      if (!reason.empty()) return reason;
  if (std::abs(o.here.most_pull) > kGreatestShare || o.here.least_sinkage < 0.0 ||
      o.here.least_sinkage > kGreatestShare)
    return "a bound is not finite and within 100";
  for (const std::string& reason :
       {outside("x_m", o.place.x_m, kGreatestPlace_m), outside("y_m", o.place.y_m, kGreatestPlace_m),
        outside("pose_std_m", o.pose_std_m, kGreatestPlace_m)})
    if (!reason.empty()) return reason;
  // An infinite standard deviation means that no sinkage was measured.
  if (!(o.pose_std_m >= 0.0) || (!bounds_alone && (!(o.pull.std >= 0.0) || !(o.sinkage.std >= 0.0))))
    return "a standard deviation is below 0 or missing";
  if (o.shared_std < 0.0 || std::isinf(o.shared_std)) return "a standard deviation is below 0 or infinite";
  if (std::isinf(o.share)) return "the share of the thrust is infinite";
  if (std::isinf(o.time_s)) return "time_s is infinite";
  return "";
}

namespace {

constexpr double kLeastShare = 0.15;  // least thrust, relative to that at the reference slip, at which slip
                                      // tells about the strength of the ground (ours)
constexpr double kFelt = 0.1;  // least torque that is extrapolated, relative to that at the reference slip
// Factor on the standard deviation of the class where the torque of the class replaces a torque that is not
// mobilised. The torque of the class is not a measurement, and the estimate includes the class already
// (ours).
constexpr double kStandIn = 2.0;
constexpr double kStanding = 0.9;  // slip from which a rover may be stationary (ours)
constexpr double kHeld =
    0.05;  // least side force over load that cannot result from a turn or a drift of the pose (ours)
constexpr double kRutRelativeStd = 1.0;  // relative error of the pull gained in a rut (ours)

bool known(double value) noexcept {
  return std::isfinite(value);
}

// Returns the value reduced by the part that its error explains: v v^2/(v^2 + e^2).
double beyondError(double value, double error) noexcept {
  const double square = value * value;
  return square > 0.0 ? value * square / (square + error * error) : 0.0;
}

// Mean of two estimates of one number, weighted by inverse variance.
Estimate combined(const Estimate& a, const Estimate& b) noexcept {
  const double wa = 1.0 / (a.std * a.std), wb = 1.0 / (b.std * b.std);
  return {(wa * a.value + wb * b.value) / (wa + wb), 1.0 / std::sqrt(wa + wb)};
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

// A reading and the values that the model predicts for the reading.
struct WheelObserver::Wheel {
  const ClassReading& read;
  SteadyWheel expected;    // wheel of the class at the measured slip, on undisturbed ground or in a rut
  SteadyWheel reference;   // wheel of the class at the reference slip, on undisturbed ground or in a rut
  double steepness = 0.0;  // change of the expected gradient for one standard deviation of slip
  double rut_gain = 0.0;   // pull in a rut minus pull on undisturbed ground, over load
  double share = 1.0;      // thrust of the class at slip angle 0, relative to the reference slip
  double asked = 0.0;      // pull over load that the slope requires in the wheel's plane
  double held = 0.0;       // side force over load that the slope requires
  double known = 0.0;      // departure of the ground at the reference slip from other data
  double from_torque = std::numeric_limits<double>::quiet_NaN();     // pull at the measured slip
  Estimate by_torque{0.0, std::numeric_limits<double>::infinity()};  // departure at the reference slip
};

WheelObserver::Wheel WheelObserver::expected(const ClassReading& read,
                                             std::span<const double> departures) const {
  const TelemetryReading& r = read.reading;
  const double radius_m = model_.rover().wheel.radius_m;
  const bool rut = r.pass > 1;
  const bool turned = known(r.slip_angle_rad) && known(r.across);
  const double angle = turned ? r.slip_angle_rad : 0.0;
  const auto at = [&](double slip, bool in_rut) {
    return model_.steady(read.class_index, {.slip = slip, .in_rut = in_rut, .slip_angle_rad = angle});
  };
  Wheel w{.read = read, .expected = at(r.slip, rut), .reference = model_.reference(read.class_index, rut)};
  w.asked = turned ? r.gradient * std::cos(angle) - r.across * std::sin(angle) : r.gradient;
  w.held = turned ? std::abs(r.gradient * std::sin(angle) + r.across * std::cos(angle)) : 0.0;
  const SteadyWheel more = at(r.slip + noise_.slip, rut), less = at(r.slip - noise_.slip, rut);
  w.steepness = (more.drawbar_pull_over_load - less.drawbar_pull_over_load) / 2.0;
  w.rut_gain = rut ? w.expected.drawbar_pull_over_load - at(r.slip, false).drawbar_pull_over_load : 0.0;
  const SteadyWheel straight =
      turned ? model_.steady(read.class_index, {.slip = r.slip, .in_rut = rut}) : w.expected;
  if (!departures.empty()) w.known = departures[static_cast<std::size_t>(read.class_index)];
  // Share at the measured slip. The part of its difference from ground with the known departure on this slope
  // that the slip error explains is removed; otherwise the error of a small slip would bias the departure.
  if (const double thrust = w.reference.torque_over_load_radius; thrust > 0.0) {
    w.share = straight.torque_over_load_radius / thrust;
    w.expected.drawbar_pull_over_load += w.known * std::max(w.share, 0.0);
    if (known(w.asked)) {
      const double there =
          model_.onSlope(read.class_index, w.asked - w.known, rut).torque_over_load_radius / thrust;
      const double error = 0.5 * (more.torque_over_load_radius - less.torque_over_load_radius) / thrust;
      w.share = there + beyondError(w.share - there, error);
    }
  }
  const double z = r.sinkage_m / radius_m, t = r.torque_Nm / (radius_m * r.load_N);
  if (!known(t) || !(z >= 0.0 && z < 1.0)) return w;
  w.from_torque = pullFromTorque(t, z);
  if (!(w.expected.sinkage_over_radius > 0.0)) return w;
  const SteadyWheel& like = w.reference;
  const double class_pull = pullFromTorque(like.torque_over_load_radius, like.sinkage_over_radius);
  const double depth = std::min(z * like.sinkage_over_radius / w.expected.sinkage_over_radius, 0.99);
  // Torque at the reference slip: extrapolated from the reading if mobilised, combined with the torque of the
  // class, whose standard deviation increases with the departure of the sinkage from the class.
  const GroundClass& ground = model_.parts().classes[static_cast<std::size_t>(read.class_index)];
  const double deeper = pullFromTorque(like.torque_over_load_radius, depth) - class_pull;
  Estimate torque{like.torque_over_load_radius,
                  kStandIn * std::hypot(ground.pull_std, ground.mean_std, deeper)};
  if (w.expected.torque_over_load_radius > kFelt * like.torque_over_load_radius) {
    const double mobilised = like.torque_over_load_radius / w.expected.torque_over_load_radius;
    torque = combined(torque,
                      {t * mobilised, noise_.torque_share * t * mobilised +
                                          noise_.mobilised * std::abs(mobilised - 1.0) + noise_.model_pull});
  }
  w.by_torque = {pullFromTorque(torque.value, depth) - class_pull,
                 std::hypot(torque.std, noise_.sinkage_share, noise_.model_pull)};
  return w;
}

// Departure of the ground under a wheel from its class by the side force, <= 0; infinite if the side force
// gives no bound.
double WheelObserver::weakerAcross(const Wheel& w) const noexcept {
  if (!(w.held >= kHeld) || !(w.expected.side_force_over_load > 0.0))
    return std::numeric_limits<double>::infinity();
  const double thrust = w.reference.torque_over_load_radius;
  return std::min(0.0, (w.held + 2.0 * std::hypot(noise_.gradient, noise_.model_pull)) /
                               w.expected.side_force_over_load -
                           1.0) *
         thrust;
}

// Departure D by P(i) + D f(i) = g with the share f of the thrust. `own`: departure of this wheel from the
// other wheels by torque and sinkage; its standard deviation is half its value.
Estimate WheelObserver::bySlope(const Wheel& w, const Balance& all, double own) const {
  // The wheels of a moment share its slip and slope: together they count as one reading.
  const double error =
      std::hypot(noise_.gradient, std::hypot(0.5 * own, w.steepness)) * std::sqrt(all.wheels);
  return {std::min(w.known + (all.departure + own) / all.share, all.across + own), error / all.share};
}

// Upper bound for a rover that may be stationary: the lower of the balance and the estimate from torque and
// sinkage, if known; at most the class.
Estimate WheelObserver::upperBound(const Wheel& w, const Balance& all) const {
  Estimate most = w.by_torque;
  if (known(all.departure)) {
    const Estimate slope = bySlope(w, all, 0.0);
    if (!known(most.std) || slope.value < most.value) most = slope;
  }
  most.value = std::min(most.value, 0.0);
  return most;
}

std::optional<WheelObservation> WheelObserver::observed(const Wheel& w, const Balance& balance,
                                                        double own) const {
  const bool by_balance = known(balance.departure);
  const TelemetryReading& reading = w.read.reading;
  WheelObservation out{.time_s = reading.time_s,
                       .place = reading.place,
                       .pull = {},
                       .sinkage = {},
                       .pose_std_m = reading.pose_std_m};
  const GroundBelief prior = model_.prior(w.read.class_index);
  Estimate seen = w.by_torque;
  if (by_balance) {
    seen = balance.share >= kLeastShare ? bySlope(w, balance, own) : Estimate{w.known, 1.0};
  }
  if (known(reading.drawbar_pull_N))
    seen = bySlope(w,
                   {.departure = reading.drawbar_pull_N / reading.load_N - w.expected.drawbar_pull_over_load,
                    .share = std::max(w.share, kLeastShare)},
                   0.0);
  else if (balance.standing)
    seen = upperBound(w, balance);
  if (!known(seen.std)) return std::nullopt;
  const double rut = kRutRelativeStd * w.rut_gain;
  out.pull = {prior.pull.value + seen.value, std::hypot(seen.std, rut)};
  out.share = balance.share;
  out.sinkage = {prior.sinkage.value, std::numeric_limits<double>::infinity()};
  const double z = reading.sinkage_m / model_.rover().wheel.radius_m;
  if (reading.pass <= 1 && z >= 0.0 && z < 1.0 && w.expected.sinkage_over_radius > 0.0) {
    const double deeper = prior.sinkage.value / w.expected.sinkage_over_radius;
    out.sinkage = {deeper * z, deeper * noise_.sinkage_share};
  }
  return out;
}

std::optional<WheelObservation> WheelObserver::observe(int class_index,
                                                       const TelemetryReading& reading) const {
  return observe({{class_index, reading}}).front();
}

std::vector<std::optional<WheelObservation>> WheelObserver::observe(
    const std::vector<ClassReading>& together, std::span<const double> departures) const {
  const auto usable = [](const ClassReading& c) { return known(c.reading.slip) && c.reading.load_N > 0.0; };
  std::vector<Wheel> wheels;
  double load = 0.0, felt_load = 0.0, felt = 0.0;
  Balance all{.departure = 0.0, .across = 0.0, .share = 0.0, .wheels = 0.0};
  for (const ClassReading& read : together) {
    if (!usable(read)) continue;
    const Wheel& w = wheels.emplace_back(expected(read, departures));
    const double load_N = read.reading.load_N;
    load += load_N;
    all.standing |= read.reading.slip >= kStanding;
    all.departure += load_N * (w.asked - w.expected.drawbar_pull_over_load);
    all.across += load_N * weakerAcross(w);
    all.wheels += 1.0;
    all.share += load_N * w.share;
    if (!known(w.from_torque)) continue;
    felt_load += load_N;
    felt += load_N * (w.from_torque - w.expected.drawbar_pull_over_load);
  }
  all.departure /= load;
  all.across /= load;
  all.share /= load;
  std::vector<std::optional<WheelObservation>> out;
  std::size_t next = 0;
  for (const ClassReading& read : together) {
    if (!usable(read)) {
      out.emplace_back();
      continue;
    }
    const Wheel& w = wheels[next++];
    const double own = w.from_torque - w.expected.drawbar_pull_over_load - felt / felt_load;
    out.push_back(observed(w, all, known(own) ? own : 0.0));
  }
  return out;
}

}  // namespace talus::costmap
