#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace talus::planner {

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
