#pragma once

namespace talus::planner {

/// Choice between two implementations of a loop with bit-identical results. The scalar implementation is for
/// machines without AVX2 and for tests.
enum class Kernels { Best, Scalar };

/// Returns true if the vector implementation (SSE 4.1 and AVX2) is selected and supported.
#if defined(__x86_64__)
inline bool vectorsRun(Kernels kernels) noexcept {
  return kernels == Kernels::Best && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("sse4.1");
}
#else
constexpr bool vectorsRun(Kernels) noexcept {
  return false;
}
#endif

}  // namespace talus::planner
