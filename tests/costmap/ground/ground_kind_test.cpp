#include <cmath>
#include <random>

#include <site_fixture.hpp>

#include <talus/costmap/ground/ground_kind.hpp>

namespace talus::costmap {
namespace ground_kind_test {

GroundBelief anyBelief(std::mt19937_64& random) {
  const auto drawn = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  return {.pull = {drawn(-1.0, 1.0), drawn(0.0, 3.0)}, .sinkage = {drawn(0.0, 2.0), 0.1}};
}

// Property: at every level what stands for a belief is no better than it in anything, and is its own kind.
TEST(GroundKind, RoundsTowardsDanger) {
  std::mt19937_64 random(3);
  const GroundClass ground{.soil = testSand()};
  for (int i = 0; i < 5000; ++i) {
    const GroundBelief belief = anyBelief(random);
    for (int level = 0; level <= GroundKind::kCoarsest; ++level) {
      const GroundKind kind = GroundKind::of(0, 0, belief, level);
      const GroundBelief worst = kind.belief(ground);
      // A millionth of a step is rounding of numbers, not of beliefs.
      GroundBelief a_little_better = belief;
      a_little_better.pull.value += 1e-6;
      a_little_better.pull.std -= 1e-5;
      a_little_better.sinkage.value -= 1e-6;
      ASSERT_TRUE(noBetter(worst, a_little_better)) << i << " level " << level;
      ASSERT_EQ(GroundKind::of(0, 0, worst, level), kind);
      if (level > 0) {
        const GroundBelief finer = GroundKind::of(0, 0, belief, level - 1).belief(ground);
        ASSERT_EQ(GroundKind::of(0, 0, finer, level), kind) << "rounded twice";
      }
    }
  }
}

TEST(GroundKind, StepsAreThoseStated) {
  const GroundClass ground{.soil = testSand()};
  // Closed form: 0.117 down to 0.10, 0.03 up to 0.02 * 2^(3/4), 0.41 up to 0.5; at level 2 steps of 0.08, an
  // octave and 0.4.
  const GroundBelief belief{.pull = {0.117, 0.03}, .sinkage = {0.41, 0.1}};
  const GroundBelief fine = GroundKind::of(0, 0, belief).belief(ground);
  EXPECT_DOUBLE_EQ(fine.pull.value, 0.10);
  EXPECT_DOUBLE_EQ(fine.pull.std, 0.02 * std::pow(2.0, 0.75));
  EXPECT_DOUBLE_EQ(fine.sinkage.value, 0.5);
  const GroundBelief coarse = GroundKind::of(0, 0, belief, 2).belief(ground);
  EXPECT_DOUBLE_EQ(coarse.pull.value, 0.08);
  EXPECT_DOUBLE_EQ(coarse.pull.std, 0.04);
  EXPECT_NEAR(coarse.sinkage.value, 0.8, 1e-12);
}

}  // namespace ground_kind_test
}  // namespace talus::costmap
