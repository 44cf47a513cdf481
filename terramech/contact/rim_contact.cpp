#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <string>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

namespace {

// 1 - sin(h)/h. Below h = 0.1 the difference cancels, so the series is used; the first omitted term
// h^8/362880 is below 1e-13 relative.
double oneMinusSinc(double h) {
  if (h > 0.1) return 1.0 - std::sin(h) / h;
  const double q = h * h;
  return q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0 * (1.0 - q / 72.0)));
}

}  // namespace

LinearStressMoments::LinearStressMoments(double entry_angle_rad) : half_angle_rad(0.5 * entry_angle_rad) {
  const double h = half_angle_rad;
  const double s = std::sin(0.5 * h);
  peak_cos = 4.0 * std::cos(h) * s * s / h;
  peak_sin = 4.0 * std::sin(h) * s * s / h;
  offset_cos = 2.0 * s * s / h;
  offset_sin = oneMinusSinc(h);
}

double peakShearDisplacement_m(const Wheel& wheel, const WheelSample& sample) {
  const double theta_1 = entryAngle_rad(wheel, sample.sinkage_m);
  const double theta_m = 0.5 * theta_1;
  return wheel.radius_m * (theta_1 - theta_m - (1.0 - sample.slip) * (std::sin(theta_1) - std::sin(theta_m)));
}

Mobilisation mobilisation(const Wheel& wheel, const WheelSample& sample, double shear_modulus_m) {
  RangeCheck("linear stress").above("shear_modulus_m", shear_modulus_m, 0.0);
  const double theta_1 = entryAngle_rad(wheel, sample.sinkage_m);
  const double bottom = wheel.radius_m * (theta_1 - (1.0 - sample.slip) * std::sin(theta_1));
  return {.peak = -std::expm1(-peakShearDisplacement_m(wheel, sample) / shear_modulus_m),
          .bottom = -std::expm1(-bottom / shear_modulus_m)};
}

double shearStrength_Pa(const Soil& soil, double normal_Pa) {
  return soil.cohesion_Pa + normal_Pa * std::tan(soil.friction_angle_rad);
}

double janosiHanamoto_Pa(const Soil& soil, double normal_Pa, double displacement_m) {
  const double mobilised = -std::expm1(-std::abs(displacement_m) / soil.shear_modulus_m);
  return std::copysign(shearStrength_Pa(soil, normal_Pa) * mobilised, displacement_m);
}

double elastoPlastic_Pa(const Soil& soil, double normal_Pa, double displacement_m) {
  const double mobilised = std::min(std::abs(displacement_m) / soil.shear_modulus_m, 1.0);
  return std::copysign(shearStrength_Pa(soil, normal_Pa) * mobilised, displacement_m);
}

Hegedus hegedus(const PushedSoil& soil) {
  const double phi = std::atan(soil.tan_friction), x = 0.25 * std::numbers::pi - 0.5 * phi;
  const double cot_x = 1.0 / std::tan(x);
  const double front = cot_x + std::tan(x + phi);
  const double heap = cot_x + cot_x * cot_x * soil.tan_friction;
  return {front * soil.cohesion_Pa, 0.5 * front * heap * soil.weight_N_m3};
}

double faceResistance_N(const Hegedus& soil, const WheelFace& face) {
  const double theta = face.entry_angle_rad, r = face.radius_m;
  const double s = std::sin(theta), c = std::cos(theta);
  // Below 0.1 rad the closed forms cancel; the series have relative errors below 1e-8.
  const double t2 = theta * theta, t3 = t2 * theta;
  const bool small = theta < 0.1;
  const double area = small ? t3 * (2.0 / 3.0 - t2 * (2.0 / 15.0 - t2 * (4.0 / 315.0))) : theta - s * c;
  const double square = small ? t3 * t2 * (2.0 / 15.0 - t2 * (11.0 / 315.0 - t2 * (17.0 / 3780.0)))
                              : s - s * s * s / 3.0 - theta * c;
  return r * r * (soil.per_depth_Pa * area + 2.0 * r * soil.per_depth_squared_N_m3 * square);
}

namespace {

void check(const Wheel& wheel, double sinkage) {
  const RangeCheck range("wheel contact");
  range.above("radius_m", wheel.radius_m, 0.0);
  range.within("sinkage_m", sinkage, {0.0, std::nextafter(2.0 * wheel.radius_m, 0.0)});
}

}  // namespace

double entryAngle_rad(const Wheel& wheel, double sinkage_m) {
  check(wheel, sinkage_m);
  return 2.0 * std::asin(std::sqrt(sinkage_m / (2.0 * wheel.radius_m)));
}

double sinkage_m(const Wheel& wheel, double entry_angle_rad) {
  const double s = std::sin(0.5 * entry_angle_rad);
  return 2.0 * wheel.radius_m * s * s;
}

double contactChord_m(const Wheel& wheel, double sinkage_m) {
  check(wheel, sinkage_m);
  return 2.0 * std::sqrt(sinkage_m * (2.0 * wheel.radius_m - sinkage_m));
}

double ShearDisplacement::signChange_rad(double lowest_rad) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  // j exceeds 0 below the entry only if q cos theta_1 < 1. The maximum of j is at q cos theta = 1; below that
  // angle j falls.
  if (p_.slip >= 0.0 || !(travel_ * std::cos(p_.entry_angle_rad) < 1.0)) return kNone;
  double positive = std::acos(1.0 / travel_), negative = lowest_rad;
  if (at_m(negative) >= 0.0) return kNone;
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (positive + negative);
    (at_m(middle) > 0.0 ? positive : negative) = middle;
  }
  return 0.5 * (positive + negative);
}

double resultantSlip(double slip, double slip_angle_rad) {
  const double beta = std::min(std::abs(slip_angle_rad), kSteepestSlipAngle_rad);
  const double c = std::cos(beta), s = std::sin(beta);
  if (slip < 0.0) return std::hypot(slip * c, s);  // divided by v, where r omega = (1 + slip) v cos beta
  return std::hypot(slip * c, (1.0 - slip) * s) /
         std::max(c, 1.0 - slip);  // divided by r omega; both times cos beta
}

SideSlipDisplacement::SideSlipDisplacement(const Parameters& p)
    : p_(p),
      travel_(std::min(travelRatio(p.slip), 1e6)),
      lateral_m_(p.radius_m * travel_ *
                 std::tan(std::clamp(p.slip_angle_rad, -kSteepestSlipAngle_rad, kSteepestSlipAngle_rad))),
      sin_entry_(std::sin(p.entry_angle_rad)) {}

double SideSlipDisplacement::signChange_rad(double lowest_rad) const {
  return ShearDisplacement{{p_.shear_radius_m, p_.slip, p_.entry_angle_rad}}.signChange_rad(lowest_rad);
}

}  // namespace talus::terramech

namespace talus::terramech::detail {

Breaks breaksAt(double zero, const Halves& h) {
  if (!(zero == zero)) return {};
  const bool in_front = zero > h.peak_rad;
  return {{0.0,
           in_front ? (h.entry_rad - zero) / (h.entry_rad - h.peak_rad)
                    : (zero - h.exit_rad) / (h.peak_rad - h.exit_rad),
           1.0},
          3};
}

void throwSunk(double load_N) {
  throw std::domain_error("the wheel sinks to its axle before the soil carries " + std::to_string(load_N) +
                          " N");
}

namespace {

constexpr double kDeepest = 0.5 * std::numbers::pi;
constexpr double kRounding = 4e-16;

}  // namespace

EntrySearch::EntrySearch(const RimLoad& wanted)
    : wanted_N_(wanted.load_N),
      entry_(std::clamp(wanted.first_guess, 1e-9, kDeepest)),
      growth_(wanted.growth),
      tolerance_(wanted.tolerance) {}

EntrySearch::Status EntrySearch::take(double load_N) {
  const bool carries = load_N >= wanted_N_;
  (carries ? high_ : low_) = entry_;
  const double log_ratio = load_N > 0.0 ? std::log(load_N / wanted_N_) : -50.0;
  if (std::abs(log_ratio) < tolerance_ || (high_ > 0.0 && high_ - low_ <= kRounding * high_))
    return Status::Found;
  if ((!carries && entry_ >= kDeepest) || ++trials_ > 200) return Status::Sunk;
  learnGrowth(log_ratio);
  const double step_to = std::min(next(log_ratio), kDeepest);
  if (std::abs(step_to - entry_) <= kRounding * entry_) return Status::Found;
  entry_ = step_to;
  return Status::Searching;
}

void EntrySearch::learnGrowth(double log_ratio) {
  const double log_entry = std::log(entry_), run = log_entry - last_log_entry_;
  const double slope = (log_ratio - last_log_ratio_) / run;
  if (trials_ > 1 && run != 0.0 && slope > 0.05 && slope < 50.0) growth_ = slope;
  last_log_entry_ = log_entry;
  last_log_ratio_ = log_ratio;
}

double EntrySearch::next(double log_ratio) const {
  const double secant = entry_ * std::exp(std::clamp(-log_ratio / growth_, -3.0, 1.0));
  const bool inside = secant > low_ && (high_ == 0.0 || secant < high_);
  if (inside) return secant;
  return high_ > 0.0 ? 0.5 * (low_ + high_) : 1.5 * entry_;
}

}  // namespace talus::terramech::detail
