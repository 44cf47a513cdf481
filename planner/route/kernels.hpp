#pragma once

namespace talus::planner {

/// Which of two twins of a loop runs. Both give the same bits; the scalar one is for machines without
/// vectors, and for tests that compare the two.
enum class Kernels { Best, Scalar };

/// Whether the vector twin (SSE 4.1 and AVX2) runs on this machine.
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
