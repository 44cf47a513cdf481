#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include <talus/terramech/contact/wong_reece_batch.hpp>
#include <talus/terramech/contact/wong_reece_kernel.hpp>

namespace talus::terramech {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr int kLanes = 4;

using Group = void (*)(const WheelCase*, WheelForces*, bool*);

void scalarGroup(const WheelCase* cases, WheelForces* forces, bool* left) {
  for (int lane = 0; lane < kLanes; ++lane)
    lanes::solveGroup<double>(cases + lane, forces + lane, left + lane);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void avx2Group(const WheelCase* cases, WheelForces* forces, bool* left) {
  lanes::solveGroup<lanes::Four>(cases, forces, left);
}

bool haveAvx2() {
  return __builtin_cpu_supports("avx2") != 0;
}
#else
constexpr Group avx2Group = scalarGroup;

constexpr bool haveAvx2() {
  return false;
}
#endif

Group groupOf(BatchKernel kernel) {
  if (kernel == BatchKernel::Avx2 && !haveAvx2())
    throw std::invalid_argument("equilibria: this machine has no AVX2; use BatchKernel::Best");
  return kernel == BatchKernel::Scalar || !haveAvx2() ? scalarGroup : avx2Group;
}

WheelForces general(const WheelCase& c, Leftover leftover) {
  if (leftover == Leftover::Nan) return {kNan, kNan, kNan, kNan};
  try {
    return equilibrium(c);
  } catch (const std::logic_error&) {
    return {kNan, kNan, kNan, kNan};
  }
}

/// Up to four cases; a short group is filled with copies of its first fast case, a slow case replaced by one.
void solveSome(std::span<const WheelCase> cases, std::span<WheelForces> forces, Group group,
               Leftover leftover) {
  const auto fast = std::find_if(cases.begin(), cases.end(), isFastCase);
  std::array<bool, kLanes> left;
  left.fill(true);
  if (fast != cases.end()) {
    std::array<WheelCase, kLanes> lane;
    lane.fill(*fast);
    for (std::size_t k = 0; k < cases.size(); ++k)
      if (isFastCase(cases[k])) lane[k] = cases[k];
    std::array<WheelForces, kLanes> solved;
    group(lane.data(), solved.data(), left.data());
    std::copy_n(solved.begin(), cases.size(), forces.begin());
  }
  for (std::size_t k = 0; k < cases.size(); ++k)
    if (left[k] || !isFastCase(cases[k])) forces[k] = general(cases[k], leftover);
}

}  // namespace

bool isFastCase(const WheelCase& c) {
  // Near no slip the shear displacement is a small difference, which lane_math.hpp does not resolve.
  const double peak = c.c1 + c.c2 * c.slip;
  const auto ordinary = [](double x) { return x > 1e-9 && x < 1e12; };
  return c.slip >= 0.01 && c.slip <= 1.0 && peak > 0.0 && peak < 0.999 && c.cohesion_Pa >= 0.0 &&
         c.cohesion_Pa < 1e9 && c.friction_angle_rad >= 0.0 && c.friction_angle_rad < 1.5 &&
         c.sinkage_exponent >= 0.1 && c.sinkage_exponent <= 2.0 && ordinary(c.sinkage_modulus) &&
         ordinary(c.shear_modulus_m) && ordinary(c.wheel_radius_m) && ordinary(c.wheel_width_m) &&
         ordinary(c.load_N);
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
          .slip = operation.slip};
}

WheelForces equilibrium(const WheelCase& c) {
  const Soil soil{.name = "of the case",
                  .cohesion_Pa = c.cohesion_Pa,
                  .friction_angle_rad = c.friction_angle_rad,
                  .sinkage_exponent = c.sinkage_exponent,
                  .frictional_modulus = c.sinkage_modulus,
                  .shear_modulus_m = c.shear_modulus_m,
                  .c1 = c.c1,
                  .c2 = c.c2};
  const Wheel wheel{.radius_m = c.wheel_radius_m, .width_m = c.wheel_width_m};
  return equilibrium(soil, wheel, {.load_N = c.load_N, .slip = c.slip});
}

void equilibria(std::span<const WheelCase> cases, std::span<WheelForces> forces, BatchKernel kernel,
                Leftover leftover) {
  if (cases.size() != forces.size())
    throw std::invalid_argument("equilibria: as many forces as cases are needed");
  const Group group = groupOf(kernel);
  for (std::size_t k = 0; k < cases.size(); k += kLanes) {
    const std::size_t count = std::min<std::size_t>(kLanes, cases.size() - k);
    solveSome(cases.subspan(k, count), forces.subspan(k, count), group, leftover);
  }
}

}  // namespace talus::terramech
