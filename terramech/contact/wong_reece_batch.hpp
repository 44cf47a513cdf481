#pragma once

#include <span>

#include <talus/terramech/contact/wheel_case.hpp>
#include <talus/terramech/contact/wong_reece.hpp>

/// Many rigid wheels at once.
namespace talus::terramech {

/// The case of a soil, a wheel and its operation; the operation's rebound must be 0.
WheelCase wheelCase(const Soil& soil, const Wheel& wheel, const WheelOperation& operation);

/// One case by the solver of wong_reece.hpp, with its errors.
WheelForces equilibrium(const WheelCase& wheel_case);

/// Whether the batch's kernel takes a case: valid and driven, away from what would overflow it.
bool isFastCase(const WheelCase& wheel_case);

/// What becomes of a case that the kernel does not solve.
enum class Leftover {
  Equilibrium,  ///< goes through equilibrium()
  Nan           ///< is left as NaN, to a caller who has another solver
};

/// Which code computes a batch. Both give the same bits.
enum class BatchKernel {
  Best,    ///< Avx2 where the machine has it, else Scalar
  Scalar,  ///< one case at a time
  Avx2     ///< four at a time
};

/// Solves every case: `forces` gets as many entries as `cases`, every number NaN where the case has no answer
/// (equilibrium() gives the reason). Agrees with equilibrium() to 1e-7 relative, drawbar pull to 1e-7 of the
/// load; to 1e-6 at a slip angle. Left over are, straight on, braked wheels, slip below 0.01, and r theta_1 /
/// K > 12; at a slip angle, slip below -0.9 or braked below 0.3 rad, and a way of a rim point over K > 40.
/// Throws std::invalid_argument when the sizes differ or the machine lacks the selected kernel. Thread-safe.
void equilibria(std::span<const WheelCase> cases, std::span<WheelForces> forces,
                BatchKernel kernel = BatchKernel::Best, Leftover leftover = Leftover::Equilibrium);

}  // namespace talus::terramech
