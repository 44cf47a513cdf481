#include <atomic>
#include <stdexcept>
#include <vector>

#include <talus/common/parallel_for.hpp>

namespace talus {
namespace parallel_for_test {

TEST(ParallelFor, EachIndexIsCalledOnceForAnyThreadCount) {
  for (std::size_t count : {0U, 1U, 5U, 1000U})
    for (int threads : {1, 2, 7}) {
      std::vector<std::atomic<int>> calls(count);
      parallelFor(count, threads, [&](std::size_t k) { ++calls[k]; });
      for (const auto& n : calls) ASSERT_EQ(n, 1);
    }
}

TEST(ParallelFor, ExceptionIsRethrownAndStopsTheLoop) {
  // Property: an exception on any thread is rethrown, and no new call begins after the exception.
  for (int threads : {1, 2, 7}) {
    std::atomic<int> calls{0};
    const auto loop = [&] {
      parallelFor(100000, threads, [&](std::size_t k) {
        ++calls;
        if (k >= 10) throw std::runtime_error("call");
      });
    };
    EXPECT_THROW(loop(), std::runtime_error);
    EXPECT_LE(calls, 10 + threads);
  }
}

}  // namespace parallel_for_test
}  // namespace talus
