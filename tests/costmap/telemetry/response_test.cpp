#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <talus/costmap/telemetry/response.hpp>

namespace talus::costmap {
namespace response_test {

const Response::Claim kClaim{.least = 0.1, .variation = 0.05};

Response lineOf(double slope, double scatter, int pairs, double spread = 0.3) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise;
  Response out;
  for (int i = 0; i < pairs; ++i) {
    const double cause = spread * (i % 10) / 10.0;
    out.add(cause, 0.2 + slope * cause + scatter * noise(random));
  }
  return out;
}

TEST(Response, FollowsRequiresASignificantSlope) {
  EXPECT_TRUE(lineOf(0.5, 0.02, 60).follows(kClaim));
  EXPECT_FALSE(lineOf(0.5, 0.02, 11).follows(kClaim)) << "too few";
  EXPECT_FALSE(lineOf(0.0, 0.02, 60).follows(kClaim)) << "stuck";
  EXPECT_FALSE(lineOf(-0.5, 0.02, 60).follows(kClaim));
  EXPECT_FALSE(lineOf(0.5, 0.5, 60).follows(kClaim)) << "lost in scatter";
  EXPECT_FALSE(lineOf(0.5, 0.0, 60, 0.05).follows(kClaim)) << "the cause hardly varies";
}

TEST(Response, NanPairsAreIgnored) {
  Response out;
  out.add(std::nan(""), 1.0);
  out.add(1.0, std::nan(""));
  EXPECT_EQ(out.size(), 0U);
  out.add(1.0, 1.25);
  out.add(3.0, 3.75);
  // Closed form: mean of 0.25 and 0.75; variance of 1 and 3
  EXPECT_DOUBLE_EQ(out.meanDifference(), 0.5);
  EXPECT_DOUBLE_EQ(out.causeVariance(), 1.0);
}

// Property: a series that follows the cause for a hundred rows and is then constant follows as a whole, but
// not in its recent window.
TEST(ResponseSeries, RecentWindowDetectsALateChange) {
  ResponseSeries series;
  for (int i = 0; i < 150; ++i) {
    const double cause = 0.2 * std::sin(0.4 * i);
    series.add(cause, i < 110 ? 0.1 + cause : 0.1);
  }
  EXPECT_TRUE(series.whole().follows(kClaim));
  EXPECT_FALSE(series.recent(0.05).follows(kClaim));
  EXPECT_GE(series.recent(0.05).size(), 24U);
}

TEST(ResponseSeries, RecentWindowExtendsUntilTheCauseVaries) {
  ResponseSeries series;
  for (int i = 0; i < 20; ++i) series.add(0.2 * (i % 2), 0.2 * (i % 2));
  for (int i = 0; i < 60; ++i) series.add(0.1, 0.1);
  EXPECT_GT(series.recent(0.02).size(), 60U);
}

}  // namespace response_test
}  // namespace talus::costmap
