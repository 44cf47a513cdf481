#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <site_map.hpp>

#include <talus/costmap/costmap.hpp>
#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/evidence/evidence.hpp>

namespace talus::costmap {

namespace block_evidence_test {

BlockEvidence summed(const std::vector<ReadingCount>& counts) {
  BlockEvidence block;
  summarise(counts, block);
  return block;
}

ReadingCount times(ReadingCount reading, std::uint16_t count) {
  reading.count = count;
  return reading;
}

TEST(ReadingCount, EstimatesAreRoundedToNearestAndBoundsTowardsDanger) {
  // Closed form: steps of 0.01 from -1.28; sinkage from 0
  EXPECT_EQ(pullReading({0.109, 0.05}, Trust::Once).step, 139);
  EXPECT_EQ(pullReading({0.104, 0.05}, Trust::Unverified).step, 138);
  EXPECT_EQ(pullReading({-5.0, 0.05}, Trust::Once).step, 0);
  EXPECT_EQ(sinkageReading(0.304, true).step, 30);
  const auto bounds = boundReadings({.most_pull = 0.109, .least_sinkage = 0.301});
  ASSERT_EQ(bounds.size(), 2U);
  EXPECT_EQ(bounds[0].step, 138);
  EXPECT_EQ(bounds[1].step, 31);
}

// Property: the readings of a block are separated by drive and verification; a mean is weighted by inverse
// variance, with the model error as the least variance. Closed forms.
TEST(BlockEvidence, PullsAreSeparatedBySource) {
  std::vector<ReadingCount> counts{times(pullReading({0.10, 0.05}, Trust::Once, 0.03), 3),
                                   times(pullReading({0.20, 0.1}, Trust::Once, 0.03), 4),
                                   times(pullReading({0.30, 0.05}, Trust::Twice, 0.02), 5),
                                   times(pullReading({0.40, 0.05}, Trust::Unverified), 6)};
  counts.push_back(counts.front());
  counts.back().drive = 9;
  const std::vector<SourcePull> pulls = pullsOf(counts);
  ASSERT_EQ(pulls.size(), 4U);
  EXPECT_EQ(pulls[0].source.trust, Trust::Unverified);
  EXPECT_NEAR(pulls[1].pull, (3 * 0.10 / 0.0025 + 4 * 0.20 / 0.01) / (3 / 0.0025 + 4 / 0.01), 1e-9);
  EXPECT_NEAR(pulls[1].variance(), 0.0004 + 1.0 / (3 / 0.0025 + 4 / 0.01), 1e-12);
  EXPECT_NEAR(pulls[1].shared, 0.03, 1e-12);
  EXPECT_EQ(pulls[2].source.trust, Trust::Twice);
  EXPECT_EQ(pulls[3].source.drive, 9);
}

TEST(BlockEvidence, SinkageIsThatOfVerifiedSensorsIfAny) {
  EXPECT_TRUE(std::isnan(summed({pullReading({0.3, 0.05}, Trust::Once)}).sinkage));
  const BlockEvidence block =
      summed({times(sinkageReading(0.1, true), 3), sinkageReading(0.5, true), sinkageReading(0.9, false)});
  EXPECT_NEAR(block.sinkage, 0.2F, 1e-6F);
  EXPECT_TRUE(block.sinkage_verified);
  EXPECT_FALSE(summed({sinkageReading(0.1, false)}).sinkage_verified);
}

// Property: the strictest of several bounds is kept, in any order and with any other readings.
TEST(BlockEvidence, StrictestBoundIsKept) {
  std::vector<ReadingCount> counts{times(pullReading({0.3, 0.05}, Trust::Once), 500)};
  for (const GroundBound& bound : {GroundBound{-0.1, 0.6}, GroundBound{-0.3, 0.8}, GroundBound{0.05, 0.55}})
    for (ReadingCount reading : boundReadings(bound)) counts.push_back(times(reading, 1));
  std::ranges::sort(counts, {}, [](const ReadingCount& c) { return std::pair(c.kind, c.step); });
  const BlockEvidence block = summed(counts);
  EXPECT_LE(block.most_pull, -0.3F);
  EXPECT_NEAR(block.most_pull, -0.3F, 0.011F);
  EXPECT_GE(block.least_sinkage, 0.8F);
  EXPECT_NEAR(block.least_sinkage, 0.8F, 0.011F);
  EXPECT_TRUE(std::isnan(summed({times(pullReading({0.3, 0.05}, Trust::Once), 500)}).most_pull));
}

TEST(BlockEvidence, SampleCountIsInverseVarianceWeighted) {
  // Closed form: a reading of standard deviation 0.05 counts as 1 sample, a reading of 0.1 as 1/4
  EXPECT_NEAR(
      samples(std::vector{pullReading({0.2, 0.05}, Trust::Once), pullReading({0.2, 0.1}, Trust::Once)}), 1.25,
      1e-9);
}

using Key = std::tuple<int, int, std::uint8_t>;
using Readings = std::map<std::tuple<std::uint8_t, std::uint8_t>, unsigned>;

Readings tableOf(const std::vector<ReadingCount>& counts) {
  Readings out;
  for (const ReadingCount& c : counts) out[{c.kind, c.step}] = c.count;
  EXPECT_EQ(out.size(), counts.size()) << "each value once";
  return out;
}

// Property: after any sequence of insertions, in any order, the content equals that of a std::map with the
// same insertions.
TEST(EvidenceBricks, MatchesAPlainMap) {
  std::mt19937 random(7);
  EvidenceBricks bricks(21, 13);  // not a multiple of the side of a brick
  std::map<Key, Readings> plain;
  for (int i = 0; i < 4000; ++i) {
    const BlockOfClass at{static_cast<int>(random() % 21), static_cast<int>(random() % 13),
                          static_cast<std::uint8_t>(random() % 2)};
    const ReadingCount reading{static_cast<std::uint8_t>(random() % 3),
                               static_cast<std::uint8_t>(random() % 5),
                               static_cast<std::uint16_t>(1 + random() % 2)};
    bricks.at(at);
    bricks.count(at, reading);
    plain[{at.column, at.row, at.terrain_class}][{reading.kind, reading.step}] += reading.count;
  }
  std::size_t all = 0;
  for (int row = -1; row <= 13; ++row)
    for (int column = -1; column <= 21; ++column) {
      for (const std::uint8_t number : {std::uint8_t{0}, std::uint8_t{1}}) {
        const auto expected = plain.find({column, row, number});
        ASSERT_EQ(bricks.find({column, row, number}) != nullptr, expected != plain.end());
        EXPECT_EQ(tableOf(bricks.counts({column, row, number})),
                  expected == plain.end() ? Readings{} : expected->second);
      }
    }
  bricks.visitAll([&](const BlockOfClass&, const BlockEvidence&) { ++all; });
  EXPECT_EQ(all, plain.size());
  // The box extends beyond the map on three sides.
  std::size_t inside = 0, visited = 0;
  for (const auto& [key, heard] : plain) inside += std::get<0>(key) <= 11 && std::get<1>(key) >= 5;
  bricks.visit({-4, 5, 11, 40}, [&](const BlockOfClass& at, const BlockEvidence&) {
    ++visited;
    EXPECT_TRUE(plain.contains({at.column, at.row, at.terrain_class}));
  });
  EXPECT_EQ(visited, inside);
  EXPECT_GT(inside, 20U);
}

// Property: a counter at its maximum stays at its maximum.
TEST(EvidenceBricks, CountsSaturate) {
  EvidenceBricks bricks(8, 8);
  bricks.at({1, 1});
  for (int i = 0; i < 3; ++i) bricks.count({1, 1}, {0, 7, 30000});
  ASSERT_EQ(bricks.counts({1, 1}).size(), 1U);
  EXPECT_EQ(bricks.counts({1, 1})[0].count, 65535);
}

std::vector<std::string> wide() {
  return std::vector<std::string>(60, std::string(60, '1'));
}

WheelObservation soft(double x, double y) {
  return {.time_s = 12.0,
          .place = {100.0 + x, 200.0 + y},
          .pull = {0.05, 0.05},
          .sinkage = {0.6, 0.05},
          .trust = Trust::Once,
          .sinkage_verified = true};
}

// A reading whose pull is lower than the class mean by `by`.
WheelObservation weaker(double x, double y, double by) {
  return {.time_s = 12.0,
          .place = {100.0 + x, 200.0 + y},
          .pull = {testGround()->prior(0).pull.value - by, 0.05},
          .sinkage = {0.2, 0.05},
          .trust = Trust::Once,
          .sinkage_verified = true};
}

TEST(TraversabilityMap, EvidenceIsLocalAndUncertaintyGrowsWithDistance) {
  TraversabilityMap map = mapOf(wide());
  const GroundBelief before = *map.ground({30, 30});
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(map.learn(soft(30.5, 30.5)));
  map.publish();
  const GroundBelief here = *map.ground({30, 30}), near = *map.ground({32, 30}), far = *map.ground({50, 50});
  EXPECT_LT(here.pull.value, before.pull.value - 0.05);
  EXPECT_LT(here.pull.std, before.pull.std);
  EXPECT_LT(here.pull.value, near.pull.value);
  EXPECT_LT(near.pull.value, far.pull.value);
  EXPECT_GT(far.pull.value, before.pull.value - 0.25 * (before.pull.value - here.pull.value))
      << "one place tells little about its class";
  EXPECT_LE(here.pull.std, near.pull.std);
  EXPECT_LE(near.pull.std, far.pull.std);
  EXPECT_LE(far.pull.std, before.pull.std);
}

TEST(TraversabilityMap, EvidenceDoesNotAffectOtherClasses) {
  std::vector<std::string> site = wide();
  for (auto& row : site) row.replace(31, 29, 29, '2');
  TraversabilityMap map = mapOf(site);
  const GroundBelief dust = *map.ground({32, 30});
  for (int i = 0; i < 20; ++i) map.learn(soft(30.5, 30.5));
  map.publish();
  EXPECT_EQ(map.ground({32, 30})->pull.value, dust.pull.value);
}

TEST(TraversabilityMap, ObservationsOutsideTheMapAreRejected) {
  TraversabilityMap map = mapOf(wide());
  EXPECT_FALSE(map.learn(soft(-5.0, 3.0)));
  EXPECT_FALSE(map.learn(soft(std::nan(""), 3.0)));
}

TEST(EvidenceField, ClassMeanMovesMoreWithManyIndependentPlaces) {
  TraversabilityMap one = mapOf(wide()), many = mapOf(wide());
  for (int i = 0; i < 200; ++i) {
    one.learn(weaker(30.5, 30.5, 0.06));
    many.learn(weaker(5.5 + 0.25 * i, 30.5, 0.06));
  }
  EXPECT_LT(many.evidence().classBelief(0).pull.value, one.evidence().classBelief(0).pull.value - 0.01);
  EXPECT_LT(many.evidence().classBelief(0).pull.std, one.evidence().classBelief(0).pull.std);
}

TEST(EvidenceField, OutlierPlacesDoNotMoveTheClassMean) {
  TraversabilityMap map = mapOf(wide()), ordinary = mapOf(wide());
  for (int i = 0; i < 20; ++i) {
    map.learn(weaker(30.5, 30.5, 0.4));
    ordinary.learn(weaker(30.5, 30.5, 0.06));
  }
  map.publish();
  // Property: readings seven standard deviations from the class change the class mean by less than one
  // standard deviation, but determine the estimate of their own cells.
  const double prior = map.model().prior(0).pull.value;
  EXPECT_GT(map.evidence().classBelief(0).pull.value, prior - 0.05);
  EXPECT_LT(map.ground({30, 30})->pull.value, prior - 0.3);
  EXPECT_NEAR(map.ground({45, 45})->pull.value, prior, 0.05);
}

TEST(TraversabilityMap, RefusedAreaStaysBlocked) {
  TraversabilityMap map = mapOf(wide());
  map.refuse({130.5, 230.5}, 2.0);
  map.publish();
  for (int row = 25; row <= 35; ++row)
    for (int column = 25; column <= 35; ++column) {
      const bool inside = std::hypot(column - 30, row - 30) <= 2.0;
      EXPECT_EQ(has(map.surface().hazards({column, row}), Hazard::Obstacle), inside) << column << ' ' << row;
      EXPECT_EQ(map.published()->at({column, row}).curve() == CellCode::kBlocked, inside)
          << column << ' ' << row;
    }
  for (int i = 0; i < 20; ++i) map.learn(weaker(30.5, 30.5, -0.1));
  map.publish();
  EXPECT_EQ(map.published()->at({30, 30}).curve(), CellCode::kBlocked);
  EXPECT_NO_THROW(map.refuse({-500.0, 1e9}, 3.0));
}

}  // namespace block_evidence_test

}  // namespace talus::costmap
