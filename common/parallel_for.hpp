#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace talus {

/// Calls each(k) for k = 0 ... count - 1 on `threads` threads, one of which is the calling thread. Calls for
/// different k must be independent. The first exception stops the loop; the exception is rethrown in the
/// calling thread after the calls in progress have finished.
template <typename Each>
void parallelFor(std::size_t count, int threads, Each each) {
  std::atomic<std::size_t> next{0};
  std::atomic_flag failed;
  std::exception_ptr failure;
  const auto work = [&]() noexcept {
    for (std::size_t k = next++; k < count; k = next++) try {
        each(k);
      } catch (...) {
        next = count;
        if (!failed.test_and_set()) failure = std::current_exception();
      }
  };
  {
    std::vector<std::jthread> helpers;
    for (int k = 1; k < threads && static_cast<std::size_t>(k) < count; ++k) helpers.emplace_back(work);
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace talus
