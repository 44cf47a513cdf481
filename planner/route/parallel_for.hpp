#pragma once

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace talus::planner {

/// Calls each(k) for k = 0 .. count - 1, on `threads` threads, this one among them. Calls for different k
/// must not depend on each other.
template <typename Each>
void parallelFor(std::size_t count, int threads, Each each) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < count; k = next++) each(k);
  };
  std::vector<std::jthread> helpers;
  for (int k = 1; k < threads && static_cast<std::size_t>(k) < count; ++k) helpers.emplace_back(work);
  work();
}

}  // namespace talus::planner
