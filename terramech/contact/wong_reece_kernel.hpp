#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <talus/terramech/contact/wheel_case.hpp>
#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/numerics/gauss_legendre.hpp>
#include <talus/terramech/numerics/lane_math.hpp>

/// The equilibrium of wong_reece.hpp for driven wheels with theta_2 = 0, written once for one lane or four.
/// Private.
namespace talus::terramech::lanes {

/// A rule for int_0^1 f(s) ds with s = t^2 or t^3, which smooths sigma ~ s^n.
template <std::size_t N>
struct PowerRule {
  std::array<double, N> s{}, ds{};
};

template <std::size_t N>
constexpr PowerRule<N> powerRule(int power) {
  constexpr auto rule = gaussLegendre<N>();
  PowerRule<N> out;
  for (std::size_t k = 0; k < N; ++k) {
    const double t = rule.node[k];
    out.s[k] = power == 2 ? t * t : t * t * t;
    out.ds[k] = power * (power == 2 ? t : t * t) * rule.weight[k];
  }
  return out;
}

inline constexpr auto kCoarse = powerRule<4>(2);  // to start the search
inline constexpr auto kFine = powerRule<12>(3);   // 1e-7 up to r theta_1 / K = 12

/// Forces over r b (torque: over r^2 b).
template <class T>
struct Sums {
  T load, torque, pull;
};

/// Constants of the lanes' cases.
template <class T>
struct Constants {
  T exponent, log_modulus;   // n, ln(k r^n)
  T cohesion, tan_friction;  // c, tan phi
  T radius_over_k, travel;   // r/K, 1 - i
  T peak;                    // theta_m / theta_1
  T log_load;                // ln(W / (r b))
};

/// Angle of a rim point below the entry, as the terms that its stresses need.
template <class T>
struct RimPoint {
  T sine, cosine;  // of theta
  T weight;        // d theta / ds
  T displacement_over_r;
};

template <class T>
TALUS_LANES void addPoint(const Constants<T>& c, const RimPoint<T>& p, T sigma, double ds, Sums<T>& sums) {
  const T mobilised = 1.0 - exponential(-c.radius_over_k * p.displacement_over_r);
  const T tau = (c.cohesion + sigma * c.tan_friction) * mobilised;
  const T w = p.weight * ds;
  sums.load = sums.load + w * (sigma * p.cosine + tau * p.sine);
  sums.torque = sums.torque + w * tau;
  sums.pull = sums.pull + w * (tau * p.cosine - sigma * p.sine);
}

/// C.8 to C.10 at entry angle x: each s gives a point in front and its mirror behind, which share sigma
/// (C.3).
template <std::size_t N, class T>
TALUS_LANES Sums<T> sumsAt(const Constants<T>& c, T x, const PowerRule<N>& rule) {
  const T sin_x = sine(x), cos_x = 1.0 - versine(x);
  const T front = x * (1.0 - c.peak), rear = x * c.peak;
  Sums<T> sums{T{}, T{}, T{}};
  for (std::size_t k = 0; k < N; ++k) {
    const T delta = front * rule.s[k];  // theta_1 - theta in front
    const T sin_d = sine(delta), vers_d = versine(delta);
    const T cos_difference = sin_x * sin_d - cos_x * vers_d;  // cos theta - cos theta_1 > 0
    const T sin_difference = sin_x * vers_d + cos_x * sin_d;  // sin theta_1 - sin theta
    const T sigma = exponential(c.log_modulus + c.exponent * logarithm(cos_difference));
    addPoint(c, {sin_x - sin_difference, cos_x + cos_difference, front, delta - c.travel * sin_difference},
             sigma, rule.ds[k], sums);
    const T theta = rear * rule.s[k];
    const T sin_r = sine(theta);
    addPoint(c, {sin_r, 1.0 - versine(theta), rear, (x - theta) - c.travel * (sin_x - sin_r)}, sigma,
             rule.ds[k], sums);
  }
  return sums;
}

/// A point of the search: ln theta_1, how far ln W is off, and the forces there.
template <class T>
struct Trial {
  T u, excess;
  Sums<T> sums;
};

template <std::size_t N, class T>
TALUS_LANES Trial<T> trialAt(const Constants<T>& c, T u, const PowerRule<N>& rule) {
  const Sums<T> sums = sumsAt(c, exponential(u), rule);
  return {u, logarithm(sums.load) - c.log_load, sums};
}

/// Secant slope of excess over u, kept physical.
template <class T>
TALUS_LANES T slopeOf(const Trial<T>& a, const Trial<T>& b, T fallback) {
  const T slope = (b.excess - a.excess) / (b.u - a.u);
  const T low = pick(slope > spread<T>(0.3), slope, fallback);
  return pick(low < spread<T>(20.0), low, fallback);
}

/// ln theta_1 after a secant step, within pi/2 and a factor e^2.
template <class T>
TALUS_LANES T stepped(const Trial<T>& trial, T slope) {
  constexpr double kDeepest = 0.45158270528945486;  // ln(pi/2)
  T step = -trial.excess / slope;
  step = pick(step < spread<T>(-2.0), spread<T>(-2.0), step);
  step = pick(step > spread<T>(1.0), spread<T>(1.0), step);
  const T u = trial.u + step;
  return pick(u > spread<T>(kDeepest), spread<T>(kDeepest), u);
}

/// What a lane found; sums are those at u.
template <class T>
struct Found {
  T u;
  Sums<T> sums;
  T converged;  // 1 or 0
};

/// Last step on straight lines through two trials: its error is second order in their excesses.
template <class T>
TALUS_LANES Found<T> extrapolated(const Trial<T>& a, const Trial<T>& b) {
  const T run = b.u - a.u;
  const T inverse = pick(run == T{}, T{}, 1.0 / run);
  const T slope = (b.excess - a.excess) * inverse;
  const T step = pick(slope == T{}, T{}, -b.excess / slope);
  const T f = step * inverse;
  return {b.u + step,
          {b.sums.load + f * (b.sums.load - a.sums.load), b.sums.torque + f * (b.sums.torque - a.sums.torque),
           b.sums.pull + f * (b.sums.pull - a.sums.pull)},
          spread<T>(1.0)};
}

template <class T>
TALUS_LANES bool allConverged(const Found<T>& found) {
  if constexpr (Traits<T>::kLanes == 1) {
    return found.converged != 0.0;
  } else {
    return found.converged[0] + found.converged[1] + found.converged[2] + found.converged[3] == 4.0;
  }
}

/// Finds theta_1 in every lane; a lane that is done keeps its result, so that lanes do not see each other.
template <class T>
TALUS_LANES Found<T> solve(const Constants<T>& c, T u) {
  constexpr double kGood = 1e-8;  // product of the last two excesses
  const T growth = 2.0 * c.exponent + 1.0;
  Trial<T> last = trialAt(c, u, kCoarse);
  Trial<T> trial = trialAt(c, stepped(last, growth), kCoarse);
  T slope = slopeOf(last, trial, growth);
  last = trial;
  trial = trialAt(c, stepped(last, slope), kCoarse);
  slope = slopeOf(last, trial, slope);
  last = trialAt(c, stepped(trial, slope), kFine);
  trial = trialAt(c, stepped(last, slope), kFine);
  Found<T> found{trial.u, trial.sums, T{}};
  for (int iteration = 0; iteration < 12; ++iteration) {
    const T product = trial.excess * last.excess;
    const auto good = (product < spread<T>(kGood)) & (product > spread<T>(-kGood));
    const Found<T> candidate = extrapolated(last, trial);
    const auto fresh = good & (found.converged == T{});
    found.u = pick(fresh, candidate.u, found.u);
    found.sums.load = pick(fresh, candidate.sums.load, found.sums.load);
    found.sums.torque = pick(fresh, candidate.sums.torque, found.sums.torque);
    found.sums.pull = pick(fresh, candidate.sums.pull, found.sums.pull);
    found.converged = pick(fresh, spread<T>(1.0), found.converged);
    if (allConverged(found)) break;
    slope = slopeOf(last, trial, slope);
    last = trial;
    trial = trialAt(c, stepped(last, slope), kFine);
  }
  return found;
}

/// The same field of the lanes' cases.
template <class T>
TALUS_LANES T gather(const WheelCase* cases, double WheelCase::*field) {
  if constexpr (Traits<T>::kLanes == 1) {
    return cases->*field;
  } else {
    return T{cases[0].*field, cases[1].*field, cases[2].*field, cases[3].*field};
  }
}

template <class T>
TALUS_LANES T tangent(T x) {
  return sine(x) / (1.0 - versine(x));
}

template <class T>
TALUS_LANES double laneOf(const T& value, int lane) {
  if constexpr (Traits<T>::kLanes == 1)
    return value;
  else
    return value[lane];
}

/// Solves the next one or four cases, which must be valid and driven; `sunk` marks lanes left to the general
/// solver.
template <class T>
TALUS_LANES void solveGroup(const WheelCase* cases, WheelForces* forces, bool* left) {
  const T r = gather<T>(cases, &WheelCase::wheel_radius_m), b = gather<T>(cases, &WheelCase::wheel_width_m);
  const T n = gather<T>(cases, &WheelCase::sinkage_exponent);
  const T load = gather<T>(cases, &WheelCase::load_N), slip = gather<T>(cases, &WheelCase::slip);
  const T peak = gather<T>(cases, &WheelCase::c1) + gather<T>(cases, &WheelCase::c2) * slip;
  const T log_r = logarithm(r);
  const T r_over_k = r / gather<T>(cases, &WheelCase::shear_modulus_m);
  const T log_modulus = logarithm(gather<T>(cases, &WheelCase::sinkage_modulus)) + n * log_r;
  const T log_load = logarithm(load / (r * b));
  const Constants<T> c{n,
                       log_modulus,
                       gather<T>(cases, &WheelCase::cohesion_Pa),
                       tangent(gather<T>(cases, &WheelCase::friction_angle_rad)),
                       r_over_k,
                       1.0 - slip,
                       peak,
                       log_load};
  // Small-angle load without shear, at the midpoint of s: W ~ r b k (r theta_1^2 (1 - a^2) / 2)^n theta_1.
  const T a = 0.5 + 0.5 * peak;
  const T shape = logarithm(0.5 * (1.0 - a * a) + 1e-9);
  const Found<T> found = solve(c, (log_load - log_modulus - n * shape) / (2.0 * n + 1.0));
  const T entry = exponential(found.u);
  const T z = r * versine(entry), torque = found.sums.torque * (r * r * b), pull = found.sums.pull * (r * b);
  for (int lane = 0; lane < Traits<T>::kLanes; ++lane) {
    forces[lane] = {laneOf(z, lane), laneOf(entry, lane), laneOf(torque, lane), laneOf(pull, lane)};
    const double stiffness = laneOf(r_over_k, lane) * laneOf(entry, lane);
    left[lane] = laneOf(found.converged, lane) == 0.0 || stiffness > 12.0 || laneOf(entry, lane) > 1.57;
  }
}

}  // namespace talus::terramech::lanes
