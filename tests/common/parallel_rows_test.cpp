#include <atomic>
#include <thread>
#include <vector>

#include <talus/common/parallel_rows.hpp>

namespace talus {
namespace parallel_rows_test {

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

}  // namespace parallel_rows_test
}  // namespace talus
