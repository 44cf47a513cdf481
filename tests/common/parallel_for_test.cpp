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

TEST(ParallelRows, EachRowIsVisitedOnceForAnyThreadCount) {
  for (int rows : {0, 1, 64, 65, 1000})
    for (int threads : {1, 2, 7}) {
      std::vector<std::atomic<int>> visits(static_cast<std::size_t>(rows));
      forEachStrip({.rows = rows, .threads = threads}, {}, [&](Rows strip) {
        for (int row = strip.first; row < strip.past; ++row) ++visits[static_cast<std::size_t>(row)];
      });
      for (const auto& count : visits) ASSERT_EQ(count, 1);
    }
}

TEST(ParallelRows, ProgressIsReportedOnTheCallingThreadAndStops) {
  std::stop_source source;
  const auto caller = std::this_thread::get_id();
  std::atomic<int> strips{0};
  const ProgressMonitor watch{.progress =
                                  [&](double fraction) {
                                    EXPECT_EQ(std::this_thread::get_id(), caller);
                                    EXPECT_TRUE(fraction > 0 && fraction <= 1);
                                    source.request_stop();
                                  },
                              .stop = source.get_token()};
  forEachStrip({.rows = 64 * 1000, .threads = 1}, watch, [&](Rows) { ++strips; });
  EXPECT_EQ(strips, 1);
}

}  // namespace parallel_for_test
}  // namespace talus
