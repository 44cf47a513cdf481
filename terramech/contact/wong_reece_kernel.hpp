#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/numerics/gauss_legendre.hpp>
#include <talus/terramech/numerics/lane_math.hpp>

namespace talus::terramech {

/// Parameters of one wheel on one soil at one load and slip, as a flat record for batch computations. Each
/// field has the meaning of the field of the same name in Soil, Wheel or WheelOperation.
struct WheelCase {
  double cohesion_Pa = 0.0;         ///< cohesion c >= 0
  double friction_angle_rad = 0.0;  ///< friction angle phi, [0, pi/2)
  double sinkage_exponent = 1.0;    ///< sinkage exponent n > 0 [-]
  double sinkage_modulus = 0.0;     ///< sinkage modulus k = k_c/b + k_phi > 0 [N/m^(n+2)]
  double shear_modulus_m = 0.02;    ///< shear deformation modulus K > 0
  double c1 = 0.43;                 ///< theta_m / theta_1 (stress-peak angle over entry angle) at slip 0 [-]
  double c2 = 0.32;                 ///< increase of theta_m / theta_1 per unit slip [-]
  double wheel_radius_m = 0.1;      ///< r > 0
  double wheel_width_m = 0.1;       ///< b > 0
  double load_N = 0.0;              ///< vertical load W > 0
  double slip = 0.0;  ///< driven (>= 0) or braked (< 0) slip in [-1, 1], defined in WheelOperation::slip
  /// Slip angle beta, [-pi/2, pi/2]. At 0 the fields below have no effect, except those of lugs and of slip
  /// sinkage.
  double slip_angle_rad = 0.0;
  double density_kg_m3 = 1600.0;       ///< bulk density of the soil > 0
  double gravity_m_s2 = 9.80665;       ///< > 0
  double digging_exponent = 0.4;       ///< [0, 2], defined in Soil
  double side_bulldozing = 1.0;        ///< >= 0, defined in Soil
  double grouser_height_m = 0.0;       ///< >= 0, defined in Wheel
  double lug_thrust = 0.0;             ///< [0, 5], defined in Wheel
  double slip_sinkage_exponent = 0.0;  ///< [0, 2], defined in Soil
};

}  // namespace talus::terramech

namespace talus::terramech::lanes {

/// Kernel of wong_reece_batch.hpp: sinkage and forces of wheels with exit angle theta_2 = 0. The code is
/// written once for one lane (one wheel case, T = double) and for four lanes (T = Four of lane_math.hpp).
/// Private.

/// Quadrature rule for int_0^1 f(s) ds with N points s and weights ds. s = t^power smooths the stress sigma ~
/// s^n.
template <std::size_t N>
struct PowerRule {
  std::array<double, N> s{}, ds{};
};

/// Returns the rule with power 2 or 3.
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

inline constexpr auto kCoarse = powerRule<4>(2);  // for the first trials of the search
inline constexpr auto kFine = powerRule<12>(3);   // relative error 1e-7 up to r theta_1 / K = 12

/// Largest ratio of rim-point path to shear modulus K at which kFine has the stated accuracy. The limit is
/// higher at a slip angle (Sideways), because the resultant displacement has no steep sign change.
template <bool Sideways>
inline constexpr double kStiffest = Sideways ? 40.0 : 12.0;

/// Forces on the rim divided by r b, and torque divided by r^2 b.
template <class T>
struct Sums {
  T load, torque, pull;
  T side{};  // 0 at slip angle 0
};

/// Constants of the wheel cases in each lane.
template <class T>
struct Constants {
  T exponent, log_modulus;   // n, ln(k r^n)
  T cohesion, tan_friction;  // c, tan phi
  T radius_over_k, travel;   // r/K, 1 - i
  T peak;                    // theta_m / theta_1
  T log_load;                // ln(W / (r b))
  T across{};                // (1 - i) tan beta: lateral travel per rolled arc
};

/// One point of the rim: geometry and shear displacement, at the rim angle theta.
template <class T>
struct RimPoint {
  T sine, cosine;  // of theta
  T weight;        // d theta / ds
  T displacement_over_r;
  T arc;  // theta_1 - theta
};

/// Adds the forces at a rim point, with the shear stress along the resultant displacement.
template <class T>
TALUS_LANES void addSlidingPoint(const Constants<T>& c, const RimPoint<T>& p, T sigma, double ds,
                                 Sums<T>& sums) {
  const T jx = p.displacement_over_r, jy = c.across * p.arc;
  const T square = jx * jx + jy * jy + 1e-200;
  const T inverse = inverseRoot(square);
  const T mobilised = 1.0 - exponential(-c.radius_over_k * (square * inverse));
  const T tau = (c.cohesion + sigma * c.tan_friction) * mobilised * inverse;  // tau / displacement
  const T w = p.weight * ds, along = tau * jx;
  sums.load = sums.load + w * (sigma * p.cosine + along * p.sine);
  sums.torque = sums.torque + w * along;
  sums.pull = sums.pull + w * (along * p.cosine - sigma * p.sine);
  sums.side = sums.side - w * (tau * jy);
}

/// Adds the forces at a rim point with normal stress sigma.
template <bool Sideways, class T>
TALUS_LANES void addPoint(const Constants<T>& c, const RimPoint<T>& p, T sigma, double ds, Sums<T>& sums) {
  if constexpr (Sideways) return addSlidingPoint(c, p, sigma, ds, sums);
  const T mobilised = 1.0 - exponential(-c.radius_over_k * p.displacement_over_r);
  const T tau = (c.cohesion + sigma * c.tan_friction) * mobilised;
  const T w = p.weight * ds;
  sums.load = sums.load + w * (sigma * p.cosine + tau * p.sine);
  sums.torque = sums.torque + w * tau;
  sums.pull = sums.pull + w * (tau * p.cosine - sigma * p.sine);
}

/// Returns the forces of thesis Eqs. C.8 to C.10 at entry angle x. Each s of the rule gives one point in
/// front of the stress peak and its mirror point behind the peak, with the same normal stress sigma (C.3).
template <bool Sideways, std::size_t N, class T>
TALUS_LANES Sums<T> sumsAt(const Constants<T>& c, T x, const PowerRule<N>& rule) {
  const T sin_x = sine(x), cos_x = 1.0 - versine(x);
  const T front = x * (1.0 - c.peak), rear = x * c.peak;
  Sums<T> sums{T{}, T{}, T{}, T{}};
  for (std::size_t k = 0; k < N; ++k) {
    const T delta = front * rule.s[k];  // theta_1 - theta in front of the peak
    const T sin_d = sine(delta), vers_d = versine(delta);
    const T cos_difference = sin_x * sin_d - cos_x * vers_d;  // cos theta - cos theta_1 > 0
    const T sin_difference = sin_x * vers_d + cos_x * sin_d;  // sin theta_1 - sin theta
    const T sigma = exponential(c.log_modulus + c.exponent * logarithm(cos_difference));
    addPoint<Sideways>(
        c, {sin_x - sin_difference, cos_x + cos_difference, front, delta - c.travel * sin_difference, delta},
        sigma, rule.ds[k], sums);
    const T theta = rear * rule.s[k];
    const T sin_r = sine(theta);
    addPoint<Sideways>(
        c, {sin_r, 1.0 - versine(theta), rear, (x - theta) - c.travel * (sin_x - sin_r), x - theta}, sigma,
        rule.ds[k], sums);
  }
  return sums;
}

/// One trial of the search for the entry angle: u = ln theta_1, excess = ln(load / wanted load), and the
/// forces.
template <class T>
struct Trial {
  T u, excess;
  Sums<T> sums;
};

template <bool Sideways, std::size_t N, class T>
TALUS_LANES Trial<T> trialAt(const Constants<T>& c, T u, const PowerRule<N>& rule) {
  const Sums<T> sums = sumsAt<Sideways>(c, exponential(u), rule);
  return {u, logarithm(sums.load) - c.log_load, sums};
}

/// Returns the secant slope d excess / d u of two trials, or `fallback` if the slope is outside (0.3, 20).
template <class T>
TALUS_LANES T slopeOf(const Trial<T>& a, const Trial<T>& b, T fallback) {
  const T slope = (b.excess - a.excess) / (b.u - a.u);
  const T low = pick(slope > spread<T>(0.3), slope, fallback);
  return pick(low < spread<T>(20.0), low, fallback);
}

/// Returns u = ln theta_1 after a secant step that is limited to [-2, 1], with theta_1 <= pi/2.
template <class T>
TALUS_LANES T stepped(const Trial<T>& trial, T slope) {
  constexpr double kDeepest = 0.45158270528945486;  // ln(pi/2)
  T step = -trial.excess / slope;
  step = pick(step < spread<T>(-2.0), spread<T>(-2.0), step);
  step = pick(step > spread<T>(1.0), spread<T>(1.0), step);
  const T u = trial.u + step;
  return pick(u > spread<T>(kDeepest), spread<T>(kDeepest), u);
}

/// Result of the search in each lane; `sums` contains the forces at u = ln theta_1.
template <class T>
struct Found {
  T u;
  Sums<T> sums;
  T converged;  // 1 or 0
};

/// Extrapolates u and the forces linearly through two trials to excess 0. The error is of second order in the
/// excesses.
template <class T>
TALUS_LANES Found<T> extrapolated(const Trial<T>& a, const Trial<T>& b) {
  const T run = b.u - a.u;
  const T inverse = pick(run == T{}, T{}, 1.0 / run);
  const T slope = (b.excess - a.excess) * inverse;
  const T step = pick(slope == T{}, T{}, -b.excess / slope);
  const T f = step * inverse;
  return {b.u + step,
          {b.sums.load + f * (b.sums.load - a.sums.load), b.sums.torque + f * (b.sums.torque - a.sums.torque),
           b.sums.pull + f * (b.sums.pull - a.sums.pull), b.sums.side + f * (b.sums.side - a.sums.side)},
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

/// Finds theta_1 in every lane, beginning at u = ln theta_1. A converged lane keeps its result, so that the
/// result is independent of the other lanes.
template <bool Sideways, class T>
TALUS_LANES Found<T> solve(const Constants<T>& c, T u) {
  constexpr double kGood = 1e-8;  // limit of the product of the last two excesses
  const T growth = 2.0 * c.exponent + 1.0;
  Trial<T> last = trialAt<Sideways>(c, u, kCoarse);
  Trial<T> trial = trialAt<Sideways>(c, stepped(last, growth), kCoarse);
  T slope = slopeOf(last, trial, growth);
  last = trial;
  trial = trialAt<Sideways>(c, stepped(last, slope), kCoarse);
  slope = slopeOf(last, trial, slope);
  last = trialAt<Sideways>(c, stepped(trial, slope), kFine);
  trial = trialAt<Sideways>(c, stepped(last, slope), kFine);
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
    if constexpr (Sideways) found.sums.side = pick(fresh, candidate.sums.side, found.sums.side);
    found.converged = pick(fresh, spread<T>(1.0), found.converged);
    if (allConverged(found)) break;
    slope = slopeOf(last, trial, slope);
    last = trial;
    trial = trialAt<Sideways>(c, stepped(last, slope), kFine);
  }
  return found;
}

/// Returns one field of the cases, one value per lane.
template <class T>
TALUS_LANES T gather(const WheelCase* cases, double WheelCase::*field) {
  if constexpr (Traits<T>::kLanes == 1) {
    return cases->*field;
  } else {
    return T{cases[0].*field, cases[1].*field, cases[2].*field, cases[3].*field};
  }
}

/// Returns shearGain() of the wheels, one value per lane.
template <class T>
TALUS_LANES T gatherGain(const WheelCase* cases) {
  const auto of = [](const WheelCase& c) {
    return shearGain(
        {.width_m = c.wheel_width_m, .grouser_height_m = c.grouser_height_m, .lug_thrust = c.lug_thrust});
  };
  if constexpr (Traits<T>::kLanes == 1) {
    return of(cases[0]);
  } else {
    return T{of(cases[0]), of(cases[1]), of(cases[2]), of(cases[3])};
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

/// Sine and cosine of the slip angle beta, which is limited to kSteepestSlipAngle_rad, and derived
/// quantities.
template <class T>
struct SideMotion {
  T sine, cosine;  // of |beta|
  T across;        // v / (r omega) tan beta, signed
  T slip;          // resultantSlip()
};

template <class T>
TALUS_LANES SideMotion<T> sideMotion(T slip, T travel, T beta) {
  const T size = pick(beta < T{}, -beta, beta);
  const T s = sine(size), c = 1.0 - versine(size);
  const T rolled =
      // v in units of r omega / cos beta (driven) or of v (braked)
      pick(slip < T{}, spread<T>(1.0), 1.0 - slip);
  const T scale = pick(slip < T{}, spread<T>(1.0), pick(c > rolled, c, rolled));
  const T x = slip * c, y = rolled * s;
  const T square = x * x + y * y + 1e-200;
  const T across = travel * s / c;
  return {s, c, pick(beta < T{}, -across, across), square * inverseRoot(square) / scale};
}

/// Returns faceResistance_N() / r^2 from the Hegedus coefficients; the second coefficient is multiplied by r.
template <class T>
TALUS_LANES T faceOverSquare(T per_depth, T per_depth_squared_r, T theta) {
  const T s = sine(theta), c = 1.0 - versine(theta), t2 = theta * theta, t3 = t2 * theta;
  const auto small = theta < spread<T>(0.3);
  const T area = pick(small, t3 * (2.0 / 3.0 - t2 * (2.0 / 15.0 - t2 * (4.0 / 315.0 - t2 * (2.0 / 2835.0)))),
                      theta - s * c);
  const T square = pick(
      small, t3 * t2 * (2.0 / 15.0 - t2 * (11.0 / 315.0 - t2 * (17.0 / 3780.0 - t2 * (461.0 / 1247400.0)))),
      s - s * s * s * (1.0 / 3.0) - theta * c);
  return per_depth * area + 2.0 * per_depth_squared_r * square;
}

/// Returns the bulldozing component of the side force [N]. This is hegedus() in lanes, with tan X = cos phi /
/// (1 + sin phi) and tan(X + phi) = cot X.
template <class T>
TALUS_LANES T bulldozing(const WheelCase* cases, T entry, T beta) {
  const T phi = gather<T>(cases, &WheelCase::friction_angle_rad),
          r = gather<T>(cases, &WheelCase::wheel_radius_m);
  const T cos_phi = 1.0 - versine(phi), cot_x = (1.0 + sine(phi)) / cos_phi;
  const T front = 2.0 * cot_x, heap = cot_x + cot_x * cot_x * (sine(phi) / cos_phi);
  const T weight = gather<T>(cases, &WheelCase::density_kg_m3) * gather<T>(cases, &WheelCase::gravity_m_s2);
  return -gather<T>(cases, &WheelCase::side_bulldozing) * sine(beta) * (r * r) *
         faceOverSquare<T>(front * gather<T>(cases, &WheelCase::cohesion_Pa), 0.5 * front * heap * weight * r,
                           entry);
}

/// Returns travelRatio() in lanes. Without a slip angle only driven wheels are allowed.
template <bool Sideways, class T>
TALUS_LANES T travelOf(T slip) {
  if constexpr (Sideways) return pick(slip < T{}, 1.0 / (1.0 + slip), 1.0 - slip);
  return 1.0 - slip;
}

/// Solves one or four cases for which isFastCase() is true. `left` marks the lanes that the general solver
/// must solve.
template <bool Sideways, class T>
TALUS_LANES void solveGroup(const WheelCase* cases, WheelForces* forces, bool* left) {
  const T r = gather<T>(cases, &WheelCase::wheel_radius_m), b = gather<T>(cases, &WheelCase::wheel_width_m);
  const T load = gather<T>(cases, &WheelCase::load_N), slip = gather<T>(cases, &WheelCase::slip);
  const T beta = gather<T>(cases, &WheelCase::slip_angle_rad), travel = travelOf<Sideways>(slip);
  const T size = pick(slip < T{}, -slip, slip);
  T n = gather<T>(cases, &WheelCase::sinkage_exponent) +
        gather<T>(cases, &WheelCase::slip_sinkage_exponent) * size;
  T across{};
  if constexpr (Sideways) {
    const SideMotion<T> motion = sideMotion(slip, travel, beta);
    n = n + gather<T>(cases, &WheelCase::digging_exponent) * (motion.slip - size);
    across = motion.across;
  }
  const T peak = gather<T>(cases, &WheelCase::c1) + gather<T>(cases, &WheelCase::c2) * slip;
  const T log_r = logarithm(r);
  const T r_over_k = r / gather<T>(cases, &WheelCase::shear_modulus_m);
  const T log_modulus = logarithm(gather<T>(cases, &WheelCase::sinkage_modulus)) + n * log_r;
  const T log_load = logarithm(load / (r * b)), gain = gatherGain<T>(cases);
  const Constants<T> c{n,
                       log_modulus,
                       gain * gather<T>(cases, &WheelCase::cohesion_Pa),
                       gain * tangent(gather<T>(cases, &WheelCase::friction_angle_rad)),
                       r_over_k,
                       travel,
                       peak,
                       log_load,
                       across};
  // Initial entry angle: solution of the load equation for small angles, without shear and with s at the
  // midpoint of its range, W ~ r b k (r theta_1^2 (1 - a^2) / 2)^n theta_1.
  const T a = 0.5 + 0.5 * peak;
  const T shape = logarithm(0.5 * (1.0 - a * a) + 1e-9);
  const Found<T> found = solve<Sideways>(c, (log_load - log_modulus - n * shape) / (2.0 * n + 1.0));
  const T entry = exponential(found.u);
  const T z = r * versine(entry), torque = found.sums.torque * (r * r * b), pull = found.sums.pull * (r * b);
  T side{};
  if constexpr (Sideways) side = found.sums.side * (r * b) + bulldozing(cases, entry, beta);
  T way = spread<T>(1.0);  // path of a rim point over the soil / arc
  if constexpr (Sideways) way = pick(slip < T{}, travel, way) + pick(across < T{}, -across, across);
  for (int lane = 0; lane < Traits<T>::kLanes; ++lane) {
    forces[lane] = {laneOf(z, lane), laneOf(entry, lane), laneOf(torque, lane), laneOf(pull, lane),
                    laneOf(side, lane)};
    const double stiffness = laneOf(r_over_k, lane) * laneOf(entry, lane) * laneOf(way, lane);
    left[lane] =
        laneOf(found.converged, lane) == 0.0 || stiffness > kStiffest<Sideways> || laneOf(entry, lane) > 1.57;
  }
}

}  // namespace talus::terramech::lanes
