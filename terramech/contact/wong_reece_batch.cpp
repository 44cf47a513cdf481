#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wong_reece_batch.hpp>
#include <talus/terramech/contact/wong_reece_kernel.hpp>

namespace talus::terramech {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr int kLanes = 4;
// Limits of the kernel at a slip angle. The shear direction of a braked wheel at a small slip angle turns
// within a short arc, which the quadrature does not resolve.
constexpr double kMostBraked = -0.9, kSmallestAngle_rad = 1e-4, kSmallestAngleBraked_rad = 0.3;

using Group = void (*)(const WheelCase*, WheelForces*, bool*);

/// Kernels of a batch: without and with a slip angle.
struct Groups {
  Group straight, sideways;
};

template <bool Sideways>
void scalarGroup(const WheelCase* cases, WheelForces* forces, bool* left) {
  for (int lane = 0; lane < kLanes; ++lane)
    lanes::solveGroup<Sideways, double>(cases + lane, forces + lane, left + lane);
}

#if defined(__x86_64__)
template <bool Sideways>
__attribute__((target("avx2"))) void avx2Group(const WheelCase* cases, WheelForces* forces, bool* left) {
  lanes::solveGroup<Sideways, lanes::Four>(cases, forces, left);
}

bool haveAvx2() {
  return __builtin_cpu_supports("avx2") != 0;
}
#else
template <bool Sideways>
constexpr Group avx2Group = scalarGroup<Sideways>;

constexpr bool haveAvx2() {
  return false;
}
#endif

Groups groupsOf(BatchKernel kernel) {
  if (kernel == BatchKernel::Avx2 && !haveAvx2())
    throw std::invalid_argument("equilibria: this machine has no AVX2; use BatchKernel::Best");
  if (kernel == BatchKernel::Scalar || !haveAvx2()) return {scalarGroup<false>, scalarGroup<true>};
  return {avx2Group<false>, avx2Group<true>};
}

WheelForces general(const WheelCase& c, Leftover leftover) {
  if (leftover == Leftover::Nan) return {kNan, kNan, kNan, kNan, kNan};
  try {
    return equilibrium(c);
  } catch (const std::logic_error&) {
    return {kNan, kNan, kNan, kNan, kNan};
  }
}

/// Flags of the up to four cases that a group solves.
using Taken = std::array<bool, kLanes>;

/// Solves the flagged cases and clears the flag of each case left unsolved. Unused lanes contain copies of
/// the first flagged case.
void solveTaken(std::span<const WheelCase> cases, std::span<WheelForces> forces, Group group, Taken& taken) {
  const auto first = std::find(taken.begin(), taken.end(), true);
  if (first == taken.end()) return;
  std::array<WheelCase, kLanes> lane;
  lane.fill(cases[static_cast<std::size_t>(first - taken.begin())]);
  for (std::size_t k = 0; k < cases.size(); ++k)
    if (taken[k]) lane[k] = cases[k];
  std::array<WheelForces, kLanes> solved;
  std::array<bool, kLanes> left;
  group(lane.data(), solved.data(), left.data());
  for (std::size_t k = 0; k < cases.size(); ++k) {
    taken[k] = taken[k] && !left[k];
    if (taken[k]) forces[k] = solved[k];
  }
}

/// Solves up to four cases.
void solveSome(std::span<const WheelCase> cases, std::span<WheelForces> forces, const Groups& groups,
               Leftover leftover) {
  Taken straight{}, sideways{};
  for (std::size_t k = 0; k < cases.size(); ++k)
    if (isFastCase(cases[k])) (cases[k].slip_angle_rad == 0.0 ? straight : sideways)[k] = true;
  solveTaken(cases, forces, groups.straight, straight);
  solveTaken(cases, forces, groups.sideways, sideways);
  for (std::size_t k = 0; k < cases.size(); ++k)
    if (!straight[k] && !sideways[k]) forces[k] = general(cases[k], leftover);
}

/// Returns true if the kernel resolves slip and slip angle. Near slip 0 at slip angle 0 the shear
/// displacement is a small difference, which lane_math.hpp does not resolve; at a slip angle the displacement
/// across dominates.
bool takesMotion(const WheelCase& c) {
  if (c.slip_angle_rad == 0.0) return c.slip >= 0.01 && c.slip <= 1.0;
  const double angle = std::abs(c.slip_angle_rad);
  const double smallest = c.slip < 0.0 ? kSmallestAngleBraked_rad : kSmallestAngle_rad;
  return c.slip >= kMostBraked && c.slip <= 1.0 && angle >= smallest && angle <= kSteepestSlipAngle_rad;
}

}  // namespace

bool isFastCase(const WheelCase& c) {
  const double peak = c.c1 + c.c2 * c.slip;
  const auto ordinary = [](double x) { return x > 1e-9 && x < 1e12; };
  return takesMotion(c) && peak > 0.0 && peak < 0.999 && c.cohesion_Pa >= 0.0 && c.cohesion_Pa < 1e9 &&
         c.friction_angle_rad >= 0.0 && c.friction_angle_rad < 1.5 && c.sinkage_exponent >= 0.1 &&
         c.sinkage_exponent <= 2.0 && ordinary(c.sinkage_modulus) && ordinary(c.shear_modulus_m) &&
         ordinary(c.wheel_radius_m) && ordinary(c.wheel_width_m) && ordinary(c.load_N) &&
         ordinary(c.density_kg_m3) && ordinary(c.gravity_m_s2) && c.digging_exponent >= 0.0 &&
         c.digging_exponent <= 2.0 && c.side_bulldozing >= 0.0 && c.side_bulldozing < 1e6 &&
         c.slip_sinkage_exponent >= 0.0 && c.slip_sinkage_exponent <= 2.0 && c.lug_thrust >= 0.0 &&
         c.lug_thrust <= 5.0 && c.grouser_height_m >= 0.0 && c.grouser_height_m <= 1.0;
}

WheelCase wheelCase(const Soil& soil, const Wheel& wheel, const WheelOperation& operation) {
  return {.cohesion_Pa = soil.cohesion_Pa,
          .friction_angle_rad = soil.friction_angle_rad,
          .sinkage_exponent = soil.sinkage_exponent,
          .sinkage_modulus = sinkageModulus(soil, wheel.width_m),
          .shear_modulus_m = soil.shear_modulus_m,
          .c1 = soil.c1,
          .c2 = soil.c2,
          .wheel_radius_m = wheel.radius_m,
          .wheel_width_m = wheel.width_m,
          .load_N = operation.load_N,
          .slip = operation.slip,
          .slip_angle_rad = operation.slip_angle_rad,
          .density_kg_m3 = soil.density_kg_m3,
          .gravity_m_s2 = operation.gravity_m_s2,
          .digging_exponent = soil.digging_exponent,
          .side_bulldozing = soil.side_bulldozing,
          .grouser_height_m = wheel.grouser_height_m,
          .lug_thrust = wheel.lug_thrust,
          .slip_sinkage_exponent = soil.slip_sinkage_exponent};
}

WheelForces equilibrium(const WheelCase& c) {
  const Soil soil{.name = "of the case",
                  .cohesion_Pa = c.cohesion_Pa,
                  .friction_angle_rad = c.friction_angle_rad,
                  .sinkage_exponent = c.sinkage_exponent,
                  .frictional_modulus = c.sinkage_modulus,
                  .shear_modulus_m = c.shear_modulus_m,
                  .c1 = c.c1,
                  .c2 = c.c2,
                  .density_kg_m3 = c.density_kg_m3,
                  .slip_sinkage_exponent = c.slip_sinkage_exponent,
                  .digging_exponent = c.digging_exponent,
                  .side_bulldozing = c.side_bulldozing};
  const Wheel wheel{.radius_m = c.wheel_radius_m,
                    .width_m = c.wheel_width_m,
                    .grouser_height_m = c.grouser_height_m,
                    .lug_thrust = c.lug_thrust};
  return equilibrium(soil, wheel,
                     {.load_N = c.load_N,
                      .slip = c.slip,
                      .slip_angle_rad = c.slip_angle_rad,
                      .gravity_m_s2 = c.gravity_m_s2});
}

void equilibria(std::span<const WheelCase> cases, std::span<WheelForces> forces, BatchKernel kernel,
                Leftover leftover) {
  if (cases.size() != forces.size())
    throw std::invalid_argument("equilibria: as many forces as cases are needed");
  const Groups groups = groupsOf(kernel);
  for (std::size_t k = 0; k < cases.size(); k += kLanes) {
    const std::size_t count = std::min<std::size_t>(kLanes, cases.size() - k);
    solveSome(cases.subspan(k, count), forces.subspan(k, count), groups, leftover);
  }
}

}  // namespace talus::terramech
