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

const GroundBelief kPrior{.pull = {0.137, 0.09}, .sinkage = {0.23, 0.1}};

bool noBetter(const GroundBelief& belief, const GroundBelief& than) {
  return belief.pull.value <= than.pull.value && belief.pull.std >= than.pull.std &&
         belief.sinkage.value >= than.sinkage.value;
}

// Property: at every level the rounded estimate is no better than the exact one in any quantity, and rounds
// to itself.
TEST(GroundKind, RoundingIsConservativeAtEveryLevel) {
  std::mt19937_64 random(3);
  const GroundClass ground{.soil = testSand()};
  for (int i = 0; i < 5000; ++i) {
    const GroundBelief belief = anyBelief(random);
    for (int level = 0; level <= GroundKind::kCoarsest; ++level) {
      const GroundKind kind = GroundKind::of(kPrior, 0, 0, belief, level);
      const GroundBelief worst = kind.belief(kPrior, ground);
      // A difference of a millionth of a step is floating-point rounding.
      GroundBelief a_little_better = belief;
      a_little_better.pull.value += 1e-6;
      a_little_better.pull.std -= 1e-5;
      a_little_better.sinkage.value -= 1e-6;
      ASSERT_TRUE(noBetter(worst, a_little_better)) << i << " level " << level;
      ASSERT_EQ(GroundKind::of(kPrior, 0, 0, worst, level), kind);
      if (level > 0) {
        const GroundBelief finer = GroundKind::of(kPrior, 0, 0, belief, level - 1).belief(kPrior, ground);
        ASSERT_EQ(GroundKind::of(kPrior, 0, 0, finer, level), kind) << "rounded twice";
      }
    }
  }
}

TEST(GroundKind, RoundingStepsMatchTheirDefinition) {
  const GroundClass ground{.soil = testSand()};
  // Closed form: pull from 0.137 down two steps of 0.02 to 0.097, standard deviation 0.03 up to 0.09 *
  // 2^(-6/4), sinkage from 0.23 up two steps of 0.1; at level 2 the steps are 0.08, an octave and 0.4.
  const GroundBelief belief{.pull = {0.108, 0.03}, .sinkage = {0.41, 0.1}};
  const GroundBelief fine = GroundKind::of(kPrior, 0, 0, belief).belief(kPrior, ground);
  EXPECT_DOUBLE_EQ(fine.pull.value, 0.097);
  EXPECT_DOUBLE_EQ(fine.pull.std, 0.09 * std::pow(2.0, -1.5));
  EXPECT_DOUBLE_EQ(fine.sinkage.value, 0.43);
  const GroundBelief coarse = GroundKind::of(kPrior, 0, 0, belief, 2).belief(kPrior, ground);
  EXPECT_DOUBLE_EQ(coarse.pull.value, 0.057);
  EXPECT_DOUBLE_EQ(coarse.pull.std, 0.045);
  EXPECT_NEAR(coarse.sinkage.value, 0.63, 1e-12);
}

// Property: an estimate no worse than the prior of its class is rounded to a value no worse than the prior,
// at any level.
TEST(GroundKind, RoundingNeverFallsBelowThePrior) {
  std::mt19937_64 random(4);
  const GroundClass ground{.soil = testSand()};
  for (int i = 0; i < 2000; ++i) {
    const auto better = [&](double most) {
      return std::uniform_real_distribution<double>(0.0, most)(random);
    };
    const GroundBelief belief{.pull = {kPrior.pull.value + better(0.1), kPrior.pull.std - better(0.05)},
                              .sinkage = {kPrior.sinkage.value - better(0.2), 0.1}};
    for (int level = 0; level <= GroundKind::kCoarsest; ++level)
      ASSERT_TRUE(noBetter(kPrior, GroundKind::of(kPrior, 0, 0, belief, level).belief(kPrior, ground)));
  }
}

}  // namespace ground_kind_test
}  // namespace talus::costmap
