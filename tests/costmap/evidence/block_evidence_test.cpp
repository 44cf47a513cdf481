#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <talus/costmap/evidence/block_evidence.hpp>

namespace talus::costmap {
namespace block_evidence_test {

const Estimate kPrior{0.2, 0.05};

BlockEvidence summed(const std::vector<ReadingCount>& counts) {
  BlockEvidence block;
  summarise(counts, kPrior, block);
  return block;
}

ReadingCount times(ReadingCount reading, std::uint16_t count) {
  reading.count = count;
  return reading;
}

TEST(ReadingCount, ReadingsAreRoundedConservatively) {
  // Closed form: steps of 0.01 from -1.28. A pull that may only lower is rounded down, other pulls to the
  // nearest step; sinkage is rounded up.
  EXPECT_EQ(pullReading({0.109, 0.05}, false).step, 138);
  EXPECT_EQ(pullReading({0.109, 0.05}, true).step, 139);
  EXPECT_EQ(pullReading({0.104, 0.05}, true).step, 138);
  EXPECT_EQ(pullReading({-5.0, 0.05}, true).step, 0);
  EXPECT_EQ(sinkageReading(0.301, true).step, 31);
  EXPECT_NE(pullReading({0.1, 0.05}, true).kind, pullReading({0.1, 0.05}, false).kind);
}

TEST(BlockEvidence, VarianceIsBoundedBelowByTheModelError) {
  const BlockEvidence block = summed({times(pullReading({0.2, 0.05}, true), 60000)});
  EXPECT_NEAR(block.pull, 0.2F, 0.011F);
  EXPECT_NEAR(std::sqrt(block.variance), 0.02F, 1e-3F);
}

TEST(BlockEvidence, WeakestPullFollowsTheWeakestReadings) {
  const BlockEvidence block =
      summed({times(pullReading({-0.25, 0.05}, true), 3), times(pullReading({0.3, 0.05}, true), 60)});
  EXPECT_LT(block.weak_pull, -0.05F);
  const BlockEvidence even = summed({times(pullReading({0.3, 0.05}, true), 63)});
  EXPECT_NEAR(even.weak_pull, 0.3F, 0.011F);
}

ReadingCount of(ReadingCount reading, std::uint16_t drive) {
  reading.drive = drive;
  return reading;
}

// Property: of two contradicting drives the weaker one determines the estimate of the place, whichever has
// more readings. A drive of few scattered readings does not lower the estimate below that of all readings
// together.
TEST(BlockEvidence, EstimateIsThatOfTheWeakestDrive) {
  const ReadingCount weak = pullReading({0.10, 0.05}, true), strong = pullReading({0.20, 0.05}, true);
  const BlockEvidence alone = summed({of(times(weak, 40), 1)});
  const BlockEvidence both = summed({of(times(weak, 40), 1), of(times(strong, 900), 2)});
  EXPECT_EQ(both.pull, alone.pull);
  EXPECT_EQ(both.variance, alone.variance);
  EXPECT_GT(summed({times(weak, 40), times(strong, 900)}).pull, alone.pull + 0.05F);
  const ReadingCount low = pullReading({0.15, 0.05}, true), high = pullReading({0.25, 0.05}, true);
  const std::vector<ReadingCount> few{of(low, 1), of(times(strong, 900), 2), of(high, 1)};
  EXPECT_NEAR(summed(few).pull, summed({low, times(strong, 900), high}).pull, 1e-6F);
}

// Returns the mean strength of places with twelve readings of each of `drives` drives; the sensor errors of
// the drives have a standard deviation of 0.01.
double meanOfSound(int drives) {
  constexpr int kPlaces = 400;
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise;
  double sum = 0.0;
  for (int place = 0; place < kPlaces; ++place) {
    std::vector<ReadingCount> counts;
    for (std::uint16_t drive = 0; drive < drives; ++drive) {
      const double off = 0.01 * noise(random);
      for (int i = 0; i < 12; ++i)
        counts.push_back(of(pullReading({0.2 + off + 0.02 * noise(random), 0.05}, true), drive));
    }
    std::ranges::sort(counts, {}, [](const ReadingCount& c) { return std::tuple(c.kind, c.step, c.drive); });
    sum += static_cast<double>(summed(counts).pull);
  }
  return sum / kPlaces;
}

// Property: the number of sound drives does not bias the estimate. (The least of eight would be 0.014
// lower.)
TEST(BlockEvidence, NumberOfConsistentDrivesDoesNotBiasTheEstimate) {
  const double one = meanOfSound(1);
  for (const int drives : {2, 3, 4, 8, 16}) {
    EXPECT_GT(meanOfSound(drives), one - 0.007) << drives;
    EXPECT_LT(meanOfSound(drives), one + 0.007) << drives;
  }
}

// Property: the estimate from the readings of one drive does not depend on the number of the drive.
TEST(BlockEvidence, EstimateIsIndependentOfDriveNumbers) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 40; ++round) {
    std::vector<ReadingCount> one, other;
    for (std::uint8_t step = 130; step < 150; ++step)
      if (const auto count = static_cast<std::uint16_t>(random() % 30)) {
        one.push_back({reading_kind::kPull, step, count, 0});
        other.push_back({reading_kind::kPull, step, count, 7});
      }
    const BlockEvidence a = summed(one), b = summed(other);
    EXPECT_EQ(a.pull, b.pull);
    EXPECT_EQ(a.weak_pull, b.weak_pull);
    EXPECT_EQ(a.variance, b.variance);
  }
}

TEST(BlockEvidence, LowerOnlyReadingsYieldNoPullEstimate) {
  const BlockEvidence block = summed({times(pullReading({0.3, 0.05}, false), 20)});
  EXPECT_TRUE(std::isnan(block.pull));
  EXPECT_TRUE(block.lowers);
}

TEST(BlockEvidence, SinkageIsThatOfTheDeepestReadings) {
  EXPECT_TRUE(std::isnan(summed({pullReading({0.3, 0.05}, true)}).sinkage));
  const BlockEvidence block = summed({times(sinkageReading(0.1, true), 40), sinkageReading(0.77, true)});
  EXPECT_GT(block.sinkage, 0.65F);
  EXPECT_TRUE(block.sinkage_raises);
  EXPECT_FALSE(summed({sinkageReading(0.1, false)}).sinkage_raises);
}

// Property: the strictest of several bounds is kept, in any order and with any other readings.
TEST(BlockEvidence, StrictestBoundIsKept) {
  std::vector<ReadingCount> counts{times(pullReading({0.3, 0.05}, true), 500)};
  for (const GroundBound& bound : {GroundBound{-0.1, 0.6}, GroundBound{-0.3, 0.8}, GroundBound{0.05, 0.55}})
    for (ReadingCount reading : boundReadings(bound)) counts.push_back(times(reading, 1));
  std::ranges::sort(counts, {}, [](const ReadingCount& c) { return std::pair(c.kind, c.step); });
  const BlockEvidence block = summed(counts);
  EXPECT_LE(block.most_pull, -0.3F);
  EXPECT_NEAR(block.most_pull, -0.3F, 0.011F);
  EXPECT_GE(block.least_sinkage, 0.8F);
  EXPECT_NEAR(block.least_sinkage, 0.8F, 0.011F);
  EXPECT_TRUE(std::isnan(summed({times(pullReading({0.3, 0.05}, true), 500)}).most_pull));
}

TEST(BlockEvidence, SampleCountIsInverseVarianceWeighted) {
  // Closed form: a reading of standard deviation 0.05 counts as 1 sample, a reading of 0.1 as 1/4
  EXPECT_NEAR(samples(std::vector{pullReading({0.2, 0.05}, true), pullReading({0.2, 0.1}, true)}), 1.25,
              1e-9);
}

}  // namespace block_evidence_test
}  // namespace talus::costmap
