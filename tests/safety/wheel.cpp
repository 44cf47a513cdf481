#include "wheel.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace safety {
namespace {

struct Forces {
  double load = 0.0, pull = 0.0, torque = 0.0, side = 0.0;
};

Forces operator+(const Forces& a, const Forces& b) {
  return {a.load + b.load, a.pull + b.pull, a.torque + b.torque, a.side + b.side};
}
Forces operator*(double s, const Forces& f) {
  return {s * f.load, s * f.pull, s * f.torque, s * f.side};
}
double largest(const Forces& f) {
  return std::fmax(std::fmax(std::abs(f.load), std::abs(f.side)),
                   std::fmax(std::abs(f.pull), std::abs(f.torque)));
}

// Path of the rim over the soil per radian of rotation, over the radius; the value of a locked wheel is
// bounded by 1e6.
double travelOf(double slip) {
  return slip >= 0.0 ? 1.0 - slip : 1.0 / std::fmax(1.0 + slip, 1e-6);
}

// Increase of the sinkage exponent through sliding sideways.
double digging(const Soil& soil, const LoadedWheel& wheel) {
  const double q = travelOf(wheel.slip), across = q * std::tan(wheel.slip_angle_rad);
  const double sliding = std::hypot(1.0 - q, across) / std::fmax(1.0, std::hypot(q, across));
  return soil.digging_exponent * (sliding - std::abs(wheel.slip));
}

// The contact at one entry angle.
class Contact {
 public:
  Contact(const Soil& soil, const LoadedWheel& wheel, double entry)
      : soil_(soil),
        wheel_(wheel),
        entry_(entry),
        peak_((soil.c1 + soil.c2 * wheel.slip) * entry),
        modulus_(soil.cohesive_modulus / wheel.width_m + soil.frictional_modulus),
        exponent_(soil.sinkage_exponent + (wheel.slip_angle_rad > 0.0 ? digging(soil, wheel) : 0.0)),
        sideways_(wheel.radius_m * travelOf(wheel.slip) * std::tan(wheel.slip_angle_rad)) {}

  // Forces [N]; torque is divided by r. The substitution t = t1 - s^2 removes the square-root singularity at
  // the entry.
  Forces forces() const {
    const auto rear = [this](double t) { return at(t); };
    const auto front = [this](double s) { return 2.0 * s * at(entry_ - s * s); };
    return wheel_.radius_m * wheel_.width_m *
           (integral(rear, 0.0, peak_) + integral(front, 0.0, std::sqrt(entry_ - peak_)));
  }

  // Force of the soil beside the wheel [N]: Hegedus' blade at each point of the chord, by the midpoint rule.
  double pushed_N() const {
    constexpr int kParts = 200;
    const double phi = soil_.friction_angle_rad, x = 0.25 * std::numbers::pi - 0.5 * phi;
    const double cot = 1.0 / std::tan(x), d1 = cot + std::tan(x + phi), d2 = cot + cot * cot * std::tan(phi);
    double sum = 0.0;
    for (int k = 0; k < kParts; ++k) {
      const double t = entry_ * (k + 0.5) / kParts;
      const double depth = wheel_.radius_m * (std::cos(t) - std::cos(entry_));
      const double weight = 0.5 * soil_.density_kg_m3 * wheel_.gravity_m_s2 * d2 * depth;
      sum += d1 * depth * (soil_.cohesion_Pa + weight) * wheel_.radius_m * std::cos(t) * entry_ / kParts;
    }
    return 2.0 * soil_.side_bulldozing * std::sin(wheel_.slip_angle_rad) * sum;
  }

 private:
  Forces at(double t) const {
    const double mirrored = t >= peak_ ? t : entry_ - t / peak_ * (entry_ - peak_);
    const double depth = wheel_.radius_m * std::fmax(std::cos(mirrored) - std::cos(entry_), 0.0);
    const double sigma = modulus_ * std::pow(depth, exponent_);
    const double j = displacement(t);
    const double strength = soil_.cohesion_Pa + sigma * std::tan(soil_.friction_angle_rad);
    const double aside = sideways_ * (entry_ - t), path = std::hypot(j, aside);
    if (!(path > 0.0)) return {sigma * std::cos(t), -sigma * std::sin(t), 0.0, 0.0};
    const double shear = strength * (1.0 - std::exp(-path / soil_.shear_modulus_m)), tau = shear * j / path;
    return {sigma * std::cos(t) + tau * std::sin(t), tau * std::cos(t) - sigma * std::sin(t), tau,
            shear * aside / path};
  }

  double displacement(double t) const {
    const double sines = std::sin(entry_) - std::sin(t), i = wheel_.slip;
    return wheel_.radius_m * (entry_ - t - travelOf(i) * sines);
  }

  template <typename F>
  Forces integral(const F& f, double a, double b) const {
    if (!(b > a)) return {};
    constexpr int kParts = 2;
    Forces sum;
    for (int k = 0; k < kParts; ++k) {
      const double low = a + (b - a) * k / kParts, high = a + (b - a) * (k + 1) / kParts;
      const Forces fl = f(low), fm = f(0.5 * (low + high)), fh = f(high);
      const Forces whole = (high - low) / 6.0 * (fl + 4.0 * fm + fh);
      sum = sum + refined(f, {low, high, fl, fm, fh, whole}, 20);
    }
    return sum;
  }

  struct Piece {
    double low, high;
    Forces at_low, at_middle, at_high, sum;
  };

  // Tolerance of the quadrature of one piece; coarser at a slip angle, to limit the time of many angles.
  double close() const { return wheel_.slip_angle_rad > 0.0 ? 1e-5 : 1e-7; }

  template <typename F>
  Forces refined(const F& f, const Piece& p, int depth) const {
    const double middle = 0.5 * (p.low + p.high);
    const Forces l = f(0.5 * (p.low + middle)), h = f(0.5 * (middle + p.high));
    const Forces left = (middle - p.low) / 6.0 * (p.at_low + 4.0 * l + p.at_middle);
    const Forces right = (p.high - middle) / 6.0 * (p.at_middle + 4.0 * h + p.at_high);
    const Forces change = left + right + -1.0 * p.sum;
    if (depth == 0 || largest(change) <= close() * largest(left + right))
      return left + right + 1.0 / 15.0 * change;
    return refined(f, {p.low, middle, p.at_low, l, p.at_middle, left}, depth - 1) +
           refined(f, {middle, p.high, p.at_middle, h, p.at_high, right}, depth - 1);
  }

  const Soil& soil_;
  const LoadedWheel& wheel_;
  double entry_, peak_, modulus_, exponent_, sideways_;
};

// Entry angle in [low, high] that carries the load. log W is nearly linear in log t1, so that the Illinois
// variant of the false position method converges in a few steps.
double entryFor(const Soil& soil, const LoadedWheel& wheel, double low, double high) {
  const auto excess = [&](double log_entry) {
    return std::log(std::fmax(Contact(soil, wheel, std::exp(log_entry)).forces().load, 1e-12) / wheel.load_N);
  };
  double a = std::log(low), b = std::log(high), at_a = excess(a), at_b = excess(b);
  int last = 0;
  for (int step = 0; step < 100 && b - a > 1e-12; ++step) {
    const double c = (a * at_b - b * at_a) / (at_b - at_a), at_c = excess(c);
    if (std::abs(at_c) < (wheel.slip_angle_rad > 0.0 ? 1e-7 : 1e-9)) return std::exp(c);
    // Illinois rule: the value at an end that is retained twice in a row is halved.
    if (at_c < 0.0) {
      a = c, at_a = at_c;
      if (last < 0) at_b *= 0.5;
    } else {
      b = c, at_b = at_c;
      if (last > 0) at_a *= 0.5;
    }
    last = at_c < 0.0 ? -1 : 1;
  }
  return std::exp(0.5 * (a + b));
}

}  // namespace

WheelAnswer drive(const Soil& soil, const LoadedWheel& wheel) {
  constexpr double kAxle = 0.5 * std::numbers::pi;
  WheelAnswer answer;
  answer.carried = Contact(soil, wheel, kAxle).forces().load > wheel.load_N;
  const double entry = answer.carried ? entryFor(soil, wheel, 1e-3, kAxle) : kAxle;
  const Contact contact(soil, wheel, entry);
  const Forces forces = contact.forces();
  answer.sinkage_m = wheel.radius_m * (1.0 - std::cos(entry));
  answer.drawbar_pull_N = forces.pull;
  answer.torque_Nm = wheel.radius_m * forces.torque;
  answer.side_force_N = forces.side + (wheel.slip_angle_rad > 0.0 ? contact.pushed_N() : 0.0);
  return answer;
}

Soil inRut(Soil soil) {
  soil.cohesive_modulus *= 4.0;
  soil.frictional_modulus *= 4.0;
  soil.shear_modulus_m /= 2.0;
  return soil;
}

}  // namespace safety
