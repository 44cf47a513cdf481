#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <talus/costmap/telemetry/step_watch.hpp>

namespace talus::costmap {
namespace step_watch_test {

constexpr double kLeast = 0.04;

// Values about 0 with scatter between places and between values, and a step at a share of the sequence.
StepWatch watchOf(std::mt19937_64& random, int places, double place_std, double step, double at) {
  std::normal_distribution<double> noise;
  StepWatch watch(kLeast);
  for (int p = 0; p < places; ++p) {
    const double place = place_std * noise(random);
    for (std::size_t i = 0; i < StepWatch::kRows; ++i)
      watch.add(place + 0.01 * noise(random) + (p >= at * places ? step : 0.0));
  }
  return watch;
}

TEST(StepWatch, StepSizeAndSignAreRecovered) {
  std::mt19937_64 random(1);
  for (const double step : {-0.1, 0.1, -0.06, 0.2})
    for (const double at : {0.25, 0.5, 0.8})
      EXPECT_NEAR(watchOf(random, 40, 0.02, step, at).step(), step, 0.3 * std::abs(step))
          << step << ' ' << at;
}

// Property: variation between places is not reported as a step, nor is a step below the threshold; at most 2
// of 2000 drives are reported wrongly.
TEST(StepWatch, ScatterYieldsNoStep) {
  std::mt19937_64 random(2);
  int found = 0;
  for (int round = 0; round < 2000; ++round)
    found += watchOf(random, 6 + round % 60, 0.01 + 0.001 * (round % 80), 0.0, 1.0).step() != 0.0 ? 1 : 0;
  EXPECT_LE(found, 2);
  EXPECT_EQ(watchOf(random, 200, 0.005, 0.02, 0.5).step(), 0.0);
}

TEST(StepWatch, StepRequiresThreePlacesOnEitherSide) {
  StepWatch watch(kLeast);
  for (std::size_t i = 0; i < 3 * StepWatch::kRows; ++i) watch.add(0.0);
  for (std::size_t i = 0; i < 3 * StepWatch::kRows - 1; ++i) watch.add(0.2);
  EXPECT_EQ(watch.step(), 0.0);
  watch.add(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(watch.step(), 0.0);
  watch.add(0.2);
  EXPECT_NEAR(watch.step(), 0.2, 1e-12);
}

}  // namespace step_watch_test
}  // namespace talus::costmap
