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

struct FreeMemory {
  void operator()(void* memory) const noexcept { std::free(memory); }
};

/// An uninitialised array of trivial values: each page is first touched by the thread that fills it.
template <typename T>
using LargeArray = std::unique_ptr<T[], FreeMemory>;

/// Allocates an array of `count` values. Large arrays request huge pages: first access and release of 4 KiB
/// pages would take longer than the computation of a map's edge costs, and a cancelled plan waits for the
/// release. Throws std::bad_alloc.
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
  if (large) madvise(array.get(), bytes, MADV_HUGEPAGE);  // falls back to small pages
#endif
  return array;
}

}  // namespace talus::planner
