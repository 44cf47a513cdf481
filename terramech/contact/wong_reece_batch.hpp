#pragma once

#include <span>

#include <talus/terramech/contact/wheel_case.hpp>
#include <talus/terramech/contact/wong_reece.hpp>

/// Equilibria of many rigid wheels in batches.
namespace talus::terramech {

/// Returns the case of a soil, a wheel and an operation. WheelCase has no rebound: operation.rebound must be
/// 0.
WheelCase wheelCase(const Soil& soil, const Wheel& wheel, const WheelOperation& operation);

/// Solves one case with equilibrium() of wong_reece.hpp; throws as that function.
WheelForces equilibrium(const WheelCase& wheel_case);

/// Returns true if the batch kernel accepts a case: every field must be in the range of the kernel, and at
/// slip angle 0 the slip must be in [0.01, 1].
bool isFastCase(const WheelCase& wheel_case);

/// Treatment of a case that the kernel does not solve.
enum class Leftover {
  Equilibrium,  ///< solved by equilibrium()
  Nan           ///< set to NaN; the caller solves the case
};

/// Implementation of a batch. All implementations give identical bits.
enum class BatchKernel {
  Best,    ///< Avx2 if the machine has AVX2, otherwise Scalar
  Scalar,  ///< one case at a time
  Avx2     ///< four cases at a time
};

/// Solves every case. `forces` must have the size of `cases`; every number of a case without solution is NaN
/// (equilibrium() throws the reason). Relative agreement with equilibrium(): 1e-7 (drawbar pull: of the
/// load), 1e-6 at a slip angle. The kernel does not solve: at slip angle 0, slip below 0.01 and r theta_1 / K
/// > 12; at a slip angle, angles below 1e-4 rad, slip below -0.9, braking below 0.3 rad, and paths of a rim
/// point above 40 K. Throws std::invalid_argument if the sizes differ or the machine lacks the selected
/// kernel. Thread-safe.
void equilibria(std::span<const WheelCase> cases, std::span<WheelForces> forces,
                BatchKernel kernel = BatchKernel::Best, Leftover leftover = Leftover::Equilibrium);

}  // namespace talus::terramech
