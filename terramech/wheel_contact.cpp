#include <algorithm>
#include <cmath>
#include <numbers>

#include <terramech/gauss_legendre.hpp>
#include <terramech/shear_displacement.hpp>
#include <terramech/wheel_contact.hpp>

namespace talus::terramech {
namespace {

constexpr auto kRule = gaussLegendre<8>();
constexpr double kDeepest = 0.5 * std::numbers::pi;

/// Integrals over the rim, those proportional to the pressure and those of cohesion alone apart, because an
/// imposed sinkage scales the first.
struct Sums {
  double load = 0.0, pull = 0.0, shear = 0.0, side = 0.0;
};
struct RimSums {
  Sums pressure, cohesion;
  double load() const { return pressure.load + cohesion.load; }
};

class Rim {
 public:
  explicit Rim(const WheelContact& c)
      : c_(c), travel_(std::min(travelRatio(c.slip), 1e6)), lateral_(lateral(c, travel_)) {}

  RimSums at(double entry) const {
    const double peak = std::clamp(c_.c1 + c_.c2 * c_.slip, 0.02, 0.98) * entry;
    const double exit =
        c_.rebound > 0.0 ? -2.0 * std::asin(std::sqrt(c_.rebound) * std::sin(0.5 * entry)) : 0.0;
    RimSums sums;
    for (std::size_t k = 0; k < kRule.node.size(); ++k) {
      // s = t^2 from either end of contact to the peak makes sigma ~ s^n smooth enough for eight points.
      const double t = kRule.node[k], s = t * t, ds = 2.0 * t * kRule.weight[k];
      const double front = entry - (entry - peak) * s;
      const double depth =
          2.0 * c_.radius_m * std::sin(0.5 * (entry + front)) * std::sin(0.5 * (entry - front));
      const double sigma = pressure(depth);
      add(front, sigma, {entry, (entry - peak) * ds}, sums);
      add(exit + (peak - exit) * s, sigma, {entry, (peak - exit) * ds}, sums);
    }
    return sums;
  }

 private:
  struct Step {
    double entry, width;
  };

  static double lateral(const WheelContact& c, double travel) {
    if (c.slip_angle_rad == 0.0) return 0.0;
    return travel * std::tan(std::clamp(c.slip_angle_rad, -1.5607, 1.5607));
  }

  double pressure(double depth) const {
    double p = c_.sinkage_modulus * std::pow(depth, c_.sinkage_exponent);
    if (depth > c_.hard_depth_m) p += c_.hard_modulus_Pa_m * (depth - c_.hard_depth_m);
    return p;
  }

  void add(double theta, double sigma, Step step, RimSums& sums) const {
    const double sine = std::sin(theta), cosine = std::cos(theta), arc = step.entry - theta;
    const double along = c_.shear_radius_m * (arc - travel_ * (std::sin(step.entry) - sine));
    double path = std::abs(along), share_x = along < 0.0 ? -1.0 : 1.0, share_y = 0.0;
    if (lateral_ != 0.0) {
      const double across = c_.radius_m * lateral_ * arc;
      path = std::hypot(along, across) + 1e-300;
      share_x = along / path;
      share_y = across / path;
    }
    const double mobilised = (1.0 - std::exp(-path / c_.shear_modulus_m)) * step.width;
    const double friction = sigma * c_.tan_friction * mobilised, cohesive = c_.cohesion_Pa * mobilised;
    sigma *= step.width;
    sums.pressure.load += sigma * cosine + friction * share_x * sine;
    sums.pressure.pull += friction * share_x * cosine - sigma * sine;
    sums.pressure.shear += friction * share_x;
    sums.pressure.side -= friction * share_y;
    sums.cohesion.load += cohesive * share_x * sine;
    sums.cohesion.pull += cohesive * share_x * cosine;
    sums.cohesion.shear += cohesive * share_x;
    sums.cohesion.side -= cohesive * share_y;
  }

  const WheelContact& c_;
  double travel_, lateral_;
};

struct Solved {
  double entry = 0.0;
  RimSums sums;
};

/// Secant steps on the logarithms of angle and load, along which the load is almost a power, inside a
/// bracket.
Solved carry(const Rim& rim, const WheelContact& c, double wanted, double guess) {
  double low = 0.0, high = kDeepest, entry = guess > 0.0 ? std::min(guess, kDeepest) : 0.3;
  double growth = 2.0 * c.sinkage_exponent + 1.0, last_entry = 0.0, last_ratio = 0.0;
  Solved solved;
  for (int iteration = 0; iteration < 60; ++iteration) {
    solved = {entry, rim.at(entry)};
    const double load = solved.sums.load();
    const double ratio = load > 0.0 ? std::log(load / wanted) : -30.0;
    if (std::abs(ratio) < 1e-9) break;
    (ratio > 0.0 ? high : low) = entry;
    if (low >= kDeepest || high - low < 1e-13) break;
    if (iteration > 0 && entry != last_entry) {
      const double slope = (ratio - last_ratio) / std::log(entry / last_entry);
      if (slope > 0.2 && slope < 30.0) growth = slope;
    }
    last_entry = entry;
    last_ratio = ratio;
    const double next = entry * std::exp(std::clamp(-ratio / growth, -2.0, 1.0));
    entry = next > low && next < high
                ? next
                : (next >= kDeepest && high == kDeepest ? kDeepest : 0.5 * (low + high));
  }
  return solved;
}

double sinkageOf(double radius_m, double entry) {
  const double half = std::sin(0.5 * entry);
  return 2.0 * radius_m * half * half;
}

/// Moves a wheel to an imposed entry angle; the pressure there is scaled so that it still carries the load.
Solved impose(const Rim& rim, double entry, double wanted, double& scale) {
  const Solved solved{entry, rim.at(entry)};
  scale = std::max(0.0, wanted - solved.sums.cohesion.load) / std::max(solved.sums.pressure.load, 1e-300);
  return solved;
}

}  // namespace

WheelContact contactOf(const Soil& soil, const Wheel& wheel) {
  WheelContact c;
  c.radius_m = c.shear_radius_m = wheel.radius_m;
  c.width_m = wheel.width_m;
  c.sinkage_modulus = sinkageModulus(soil, wheel.width_m);
  c.sinkage_exponent = soil.sinkage_exponent;
  c.cohesion_Pa = soil.cohesion_Pa;
  c.tan_friction = std::tan(soil.friction_angle_rad);
  c.shear_modulus_m = soil.shear_modulus_m;
  c.density_kg_m3 = soil.density_kg_m3;
  c.c1 = soil.c1;
  c.c2 = soil.c2;
  return c;
}

ContactForces solveContact(const WheelContact& c, double entry_guess_rad) {
  const Rim rim{c};
  const double area = c.radius_m * c.width_m, wanted = c.load_N / area;
  Solved solved = carry(rim, c, wanted, entry_guess_rad);
  const double static_entry = solved.entry;
  double scale = 1.0;
  if (c.sinkage_gain != 1.0 || c.extra_sinkage_m != 0.0) {
    const double z = std::clamp(c.sinkage_gain * sinkageOf(c.radius_m, solved.entry) + c.extra_sinkage_m,
                                1e-6 * c.radius_m, c.radius_m);
    solved = impose(rim, 2.0 * std::asin(std::sqrt(0.5 * z / c.radius_m)), wanted, scale);
  } else if (solved.entry >= kDeepest) {
    solved = impose(rim, kDeepest, wanted, scale);
  }
  const Sums &p = solved.sums.pressure, &q = solved.sums.cohesion;
  return {.sinkage_m = sinkageOf(c.radius_m, solved.entry),
          .entry_angle_rad = solved.entry,
          .static_entry_rad = static_entry,
          .torque_Nm = (scale * p.shear + q.shear) * area * c.shear_radius_m,
          .drawbar_pull_N = (scale * p.pull + q.pull) * area,
          .side_force_N = (scale * p.side + q.side) * area};
}

}  // namespace talus::terramech
