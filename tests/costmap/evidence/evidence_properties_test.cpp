// Properties of the evidence on random sites with random observations, checked by brute force over all cells.
#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include <site_map.hpp>

#include <talus/costmap/map/map_file.hpp>

namespace talus::costmap {
namespace evidence_properties_test {

constexpr int kSide = 30;

// Patches of sand and dust whose borders cross blocks.
std::vector<std::string> randomSite(std::mt19937_64& random) {
  std::vector<std::string> rows(kSide, std::string(kSide, '1'));
  for (int patch = 0; patch < 3; ++patch) {
    const int west = static_cast<int>(random() % 25), south = static_cast<int>(random() % 25);
    for (int row = south; row < std::min(south + 9, kSide); ++row)
      for (int column = west; column < std::min(west + 7, kSide); ++column)
        rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = '2';
  }
  return rows;
}

// The correlation length makes a block two cells wide.
std::shared_ptr<const GroundModel> ground() {
  return testGround({.correlation_length_m = 8.0});
}

TraversabilityMap mapOf(const std::vector<std::string>& site) {
  return TraversabilityMap(drawn(site), ground(), {});
}

std::vector<WheelObservation> randomLog(std::mt19937_64& random, int rows) {
  std::uniform_real_distribution<double> place(0.0, kSide), share(0.0, 1.0);
  std::normal_distribution<double> pull(0.2, 0.15), sinkage(0.2, 0.15);
  std::vector<WheelObservation> log;
  for (int i = 0; i < rows; ++i) {
    WheelObservation seen{.time_s = 1.0 + i,
                          .place = {100.0 + place(random), 200.0 + place(random)},
                          .pull = {},
                          .sinkage = {0.0, std::numeric_limits<double>::infinity()}};
    // Some places are driven repeatedly.
    if (i > 5 && share(random) < 0.6) seen.place = log[random() % 5].place;
    seen.pull = {pull(random), 0.025 * static_cast<double>(1U << random() % 4)};
    if (share(random) < 0.5) seen.sinkage = {std::abs(sinkage(random)), 0.05};
    if (share(random) < 0.3) seen.pose_std_m = 2.0 * share(random);
    seen.pull_may_raise = share(random) < 0.8;
    seen.sinkage_may_raise = share(random) < 0.8;
    log.push_back(seen);
  }
  return log;
}

TraversabilityMap learned(const std::vector<std::string>& site, const std::vector<WheelObservation>& log) {
  TraversabilityMap map = mapOf(site);
  for (const WheelObservation& seen : log) map.learn(seen);
  map.publishAll();
  return map;
}

std::string bytesOf(const TraversabilityMap& map) {
  std::stringstream stream;
  writeMap(map, stream);
  return stream.str();
}

// The largest increase of a cell's strength, or decrease of its sinkage, from one map to another.
double mostRise(const TraversabilityMap& from, const TraversabilityMap& to) {
  double most = -1.0;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      const GroundBelief a = *from.ground({column, row}), b = *to.ground({column, row});
      most = std::max({most, b.pull.value - a.pull.value, a.sinkage.value - b.sinkage.value});
    }
  return most;
}

TEST(Evidence, ResultIsIndependentOfReadingOrder) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    std::mt19937_64 random(seed);
    const auto site = randomSite(random);
    std::vector<WheelObservation> log = randomLog(random, 120);
    const std::string bytes = bytesOf(learned(site, log));
    std::reverse(log.begin(), log.end());
    EXPECT_EQ(bytesOf(learned(site, log)), bytes);
    std::shuffle(log.begin(), log.end(), random);
    EXPECT_EQ(bytesOf(learned(site, log)), bytes);
  }
}

// Property: a reading of ground weaker than all earlier readings increases no estimate.
TEST(Evidence, WeakReadingNeverIncreasesAnyEstimate) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::mt19937_64 random(seed);
    const auto site = randomSite(random);
    std::vector<WheelObservation> log = randomLog(random, 80);
    const TraversabilityMap before = learned(site, log);
    WheelObservation trap = log[random() % 40];
    trap.pull = {-0.6, 0.05};
    trap.sinkage = {0.9, 0.05};
    trap.pull_may_raise = seed % 2 == 0;
    log.push_back(trap);
    const TraversabilityMap after = learned(site, log);
    EXPECT_LE(mostRise(before, after), 1e-12) << seed;
    const maps::Cell cell = *after.grid().cellAt(trap.place);
    EXPECT_LT(after.ground(cell)->pull.value, 0.0) << seed;
    EXPECT_GT(after.ground(cell)->sinkage.value, 0.6) << seed;
  }
}

TEST(Evidence, ReplacingAReadingByAWeakerOneIncreasesNoEstimate) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937_64 random(seed);
    const auto site = randomSite(random);
    std::vector<WheelObservation> log = randomLog(random, 80);
    const TraversabilityMap before = learned(site, log);
    WheelObservation& changed = log[random() % log.size()];
    changed.pull.value -= std::exponential_distribution<double>(8.0)(random);
    changed.sinkage.value += 0.1;
    EXPECT_LE(mostRise(before, learned(site, log)), 1e-12) << seed;
  }
}

// Property: readings of unverified sensors improve no cell, neither in the mean nor in the tail that
// determines the risk.
TEST(Evidence, LowerOnlyReadingsNeverIncreaseAnyEstimate) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::mt19937_64 random(seed);
    const auto site = randomSite(random);
    std::vector<WheelObservation> log = randomLog(random, 80);
    for (WheelObservation& seen : log) seen.pull_may_raise = seen.sinkage_may_raise = false;
    const TraversabilityMap before = mapOf(site), after = learned(site, log);
    EXPECT_LE(mostRise(before, after), 0.0) << seed;
    for (int row = 0; row < kSide; ++row)
      for (int column = 0; column < kSide; ++column) {
        const Estimate a = before.ground({column, row})->pull, b = after.ground({column, row})->pull;
        for (const double z : {1.0, 3.0, 6.0}) EXPECT_LE(b.value - z * b.std, a.value - z * a.std + 1e-12);
      }
  }
}

// Property: after twenty weak readings in one cell, with strong readings in all blocks around, the estimate
// of the cell is that of its readings, for any position of the block in its patch.
TEST(Evidence, WeakEvidenceOfACellIsNeverDroppedForItsNeighbours) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    std::mt19937_64 random(seed);
    const maps::Cell trap{static_cast<int>(random() % 40), static_cast<int>(random() % 40)};
    TraversabilityMap map(drawn(std::vector<std::string>(40, std::string(40, '1'))), testGround(), {});
    const auto read = [&](maps::Cell cell, double pull) {
      const maps::Point middle = map.grid().centre(cell);
      for (int i = 0; i < 20; ++i)
        map.learn({.time_s = 1.0,
                   .place = middle,
                   .pull = {pull, 0.05},
                   .sinkage = {0.2, 0.05},
                   .pull_may_raise = true,
                   .sinkage_may_raise = true});
    };
    for (int row = 0; row < 40; ++row)
      for (int column = 0; column < 40; ++column)
        read({column, row}, maps::Cell{column, row} == trap ? -0.25 : 0.35);
    map.publishAll();
    EXPECT_NEAR(map.ground(trap)->pull.value, -0.25, 0.06) << trap.column << ' ' << trap.row;
    EXPECT_EQ(map.belief(trap).category, static_cast<std::uint8_t>(terramech::Category::Dangerous));
  }
}

TEST(Evidence, ClassesWithinABlockHaveSeparateEvidence) {
  std::vector<std::string> site(30, std::string(30, '1'));
  for (auto& row : site) row.replace(15, 15, 15, '2');  // through the middle of a block of two cells
  for (const bool dust_first : {false, true}) {
    TraversabilityMap map = mapOf(site);
    const auto learn = [&](double x, double pull) {
      for (int i = 0; i < 20; ++i)
        EXPECT_TRUE(map.learn({.time_s = 1.0,
                               .place = {100.0 + x, 215.5},
                               .pull = {pull, 0.05},
                               .sinkage = {0.2, std::numeric_limits<double>::infinity()}}));
    };
    if (dust_first) learn(15.5, -0.3);
    learn(14.5, 0.2);
    if (!dust_first) learn(15.5, -0.3);
    map.publishAll();
    EXPECT_LT(map.ground({15, 15})->pull.value, -0.2);
    EXPECT_GT(map.ground({14, 15})->pull.value, 0.1) << "sand beside it keeps its own";
  }
}

// Property: three weak readings in one block outweigh sixty strong ones, in either order.
TEST(Evidence, FewWeakReadingsOutweighManyStrongOnes) {
  for (const bool weak_first : {false, true}) {
    TraversabilityMap map = mapOf(std::vector<std::string>(30, std::string(30, '1')));
    const auto learn = [&](double pull, int times) {
      for (int i = 0; i < times; ++i)
        map.learn({.time_s = 1.0,
                   .place = {115.5, 215.5},
                   .pull = {pull, 0.05},
                   .sinkage = {0.2, 0.05},
                   .pull_may_raise = true,
                   .sinkage_may_raise = true});
    };
    if (weak_first) learn(-0.25, 3);
    learn(0.3, 60);
    if (!weak_first) learn(-0.25, 3);
    map.publishAll();
    EXPECT_LT(map.ground({15, 15})->pull.value, -0.1);
    EXPECT_EQ(map.belief({15, 15}).category, static_cast<std::uint8_t>(terramech::Category::Dangerous));
  }
}

TEST(Evidence, FirstDeepSinkageIsFullyWeighted) {
  TraversabilityMap map = mapOf(std::vector<std::string>(30, std::string(30, '1')));
  WheelObservation seen{.time_s = 1.0,
                        .place = {115.5, 215.5},
                        .pull = {0.25, 0.05},
                        .sinkage = {0.0, std::numeric_limits<double>::infinity()},
                        .pull_may_raise = true};
  for (int i = 0; i < 60; ++i) map.learn(seen);
  seen.sinkage = {0.77, 0.05};
  map.learn(seen);
  map.publishAll();
  EXPECT_NEAR(map.ground({15, 15})->sinkage.value, 0.77, 0.02);
}

// Property: a pose with a standard deviation of one metre makes all ground within two metres, of any class,
// as weak as the reading. A strong reading counts only if all of that ground is of one class.
TEST(Evidence, PoseErrorSpreadsWeakEvidenceAndRestrictsStrongEvidence) {
  std::vector<std::string> site(30, std::string(30, '1'));
  for (auto& row : site) row.replace(15, 15, 15, '2');
  TraversabilityMap map = mapOf(site);
  for (int i = 0; i < 20; ++i)
    map.learn({.time_s = 1.0,
               .place = {113.5, 215.5},
               .pull = {-0.4, 0.05},
               .sinkage = {0.2, std::numeric_limits<double>::infinity()},
               .pose_std_m = 1.0,
               .pull_may_raise = true});
  map.publishAll();
  EXPECT_LT(map.ground({13, 15})->pull.value, -0.3);
  EXPECT_LT(map.ground({13, 17})->pull.value, -0.3) << "two metres off";
  EXPECT_LT(map.ground({15, 15})->pull.value, -0.3) << "two metres off, of the other class";
  EXPECT_GT(map.ground({20, 15})->pull.value, -0.3);
  EXPECT_TRUE(std::isnan(map.evidence().evidence({13, 15})->pull)) << "it may have stood on dust";
}

}  // namespace evidence_properties_test
}  // namespace talus::costmap
