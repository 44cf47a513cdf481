#pragma once

#include <span>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/contact/wong_reece_kernel.hpp>

/// Sinkage and forces of many rigid wheels, computed in batches.
namespace talus::terramech {

/// Returns the batch record of a soil, a wheel and an operation (load, slip, slip angle). WheelCase has no
/// field for rebound: operation.rebound must be 0.
WheelCase wheelCase(const Soil& soil, const Wheel& wheel, const WheelOperation& operation);

/// Returns sinkage and forces of one case, computed by equilibrium() of wheel_on_soil.hpp. Throws the exceptions
/// of that function.
WheelForces equilibrium(const WheelCase& wheel_case);

/// Returns true if the batch kernel accepts a case. Every field must be in the range of the kernel, and at
/// slip angle 0 the slip must be in [0.01, 1].
bool isFastCase(const WheelCase& wheel_case);

/// Treatment of a case that the batch kernel does not solve.
enum class Leftover {
  Equilibrium,  ///< the case is solved by equilibrium()
  Nan           ///< the forces are set to NaN; the caller solves the case
};

/// Implementation of the batch kernel. All implementations give bit-identical results.
enum class BatchKernel {
  Best,    ///< Avx2 if the processor supports AVX2, otherwise Scalar
  Scalar,  ///< solves one case at a time
  Avx2     ///< solves four cases at a time
};

/// Writes sinkage and forces of each case to `forces`, which must have the size of `cases`. Every number of a
/// case without solution is NaN; equilibrium() throws the reason. The results agree with equilibrium() within
/// a relative difference of 1e-7 (drawbar pull: relative to the load), and of 1e-6 at a slip angle. The
/// kernel does not solve, at slip angle 0, a slip below 0.01 and r theta_1 / K > 12; at a slip angle, slip
/// angles below 1e-4 rad, slip below -0.9, braked slip at slip angles below 0.3 rad, and paths of a rim point
/// over the soil above 40 K. Throws std::invalid_argument if the sizes differ or the processor does not
/// support the selected kernel. Thread-safe.
void equilibria(std::span<const WheelCase> cases, std::span<WheelForces> forces,
                BatchKernel kernel = BatchKernel::Best, Leftover leftover = Leftover::Equilibrium);

}  // namespace talus::terramech
