#pragma once

#include <array>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

#if defined(__linux__)
#include <sys/mman.h>
#endif

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

/// Eight values; loops over them have a fixed length, so that the compiler makes vectors of them.
using Lanes = std::array<float, 8>;

/// Returns the lower of two values, and the lowest of eight. Unlike std::min, the result may be a copy.
inline float less(float a, float b) noexcept {
  return a < b ? a : b;
}
inline float leastOf(const Lanes& of) noexcept {
  return less(less(less(of[0], of[4]), less(of[1], of[5])), less(less(of[2], of[6]), less(of[3], of[7])));
}

/// Deleter that releases memory with std::free().
struct FreeMemory {
  void operator()(void* memory) const noexcept { std::free(memory); }
};

/// Array of values of trivial type that are not initialised. Each memory page is first accessed by the thread
/// that fills it.
template <typename T>
using LargeArray = std::unique_ptr<T[], FreeMemory>;

/// Allocates an array of `count` values. Large arrays request huge pages. With pages of 4 KiB, first access
/// and release would take longer than the computation of the edge costs of a map, and a cancelled plan would
/// wait for the release. Throws std::bad_alloc.
template <typename T>
LargeArray<T> makeLargeArray(std::size_t count) {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  constexpr std::size_t kHugePage = std::size_t{1} << 21, kLine = 64;
  const bool large = count * sizeof(T) >= 2 * kHugePage;
  const std::size_t unit = large ? kHugePage : kLine;
  const std::size_t bytes = (count * sizeof(T) + unit - 1) / unit * unit;
  LargeArray<T> array(static_cast<T*>(std::aligned_alloc(unit, bytes)));
  if (!array) throw std::bad_alloc();
#if defined(__linux__)
  if (large) madvise(array.get(), bytes, MADV_HUGEPAGE);  // without huge pages, small pages are used
#endif
  return array;
}

}  // namespace talus::planner
