#include <cmath>
#include <random>

#include <talus/cli/draw/ticks.hpp>

namespace talus::cli {
namespace ticks_test {

using testing::ElementsAre;

TEST(Ticks, TicksAreRoundAndWithinTheRange) {
  EXPECT_THAT(ticks({0.0, 1.0}, 5),
              ElementsAre(0.0, 0.2, testing::DoubleEq(0.4), testing::DoubleNear(0.6, 1e-12), 0.8, 1.0));
  EXPECT_THAT(ticks({-3.0, 7.0}, 5), ElementsAre(-2.0, 0.0, 2.0, 4.0, 6.0));
  EXPECT_THAT(ticks({2.0, 2.0}, 5), ElementsAre(2.0));
  EXPECT_EQ(tickLabel(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(tickLabel(-1e-18, 0.1), "0.0");
}

// Property: ticks lie inside the axis at a constant step of 1, 2 or 5 times a power of ten; their number is
// within a factor of 1.6 of the requested number, plus or minus one.
TEST(Ticks, TicksOfRandomAxesAreRoundAndEquidistant) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> power(-9.0, 9.0), share(0.0, 3.0);
  for (int k = 0; k < 3'000; ++k) {
    const double span = std::pow(10.0, power(random)), low = (share(random) - 1.5) * span;
    const int count = 3 + k % 8;
    const auto marks = ticks({low, low + span}, count);
    ASSERT_GE(static_cast<double>(marks.size()), count / 1.6 - 1) << low << " " << span;
    ASSERT_LE(static_cast<double>(marks.size()), 1.6 * count + 1) << low << " " << span;
    EXPECT_GE(marks.front(), low - 1e-6 * span);
    EXPECT_LE(marks.back(), low + span + 1e-6 * span);
    if (marks.size() < 2) continue;
    const double step = marks[1] - marks[0];
    EXPECT_NEAR(roundBelow(step * (1 + 1e-9)), step, 1e-6 * step);
    for (std::size_t i = 1; i < marks.size(); ++i) EXPECT_NEAR(marks[i] - marks[i - 1], step, 1e-6 * step);
  }
}

TEST(Ticks, RoundBelowIsTheLargestRoundNumber) {
  EXPECT_DOUBLE_EQ(roundBelow(1.0), 1.0);
  EXPECT_DOUBLE_EQ(roundBelow(0.049), 0.02);
  EXPECT_DOUBLE_EQ(roundBelow(999.0), 500.0);
  EXPECT_DOUBLE_EQ(roundBelow(1000.0), 1000.0);
}

}  // namespace ticks_test
}  // namespace talus::cli
