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

// Property: the rounded estimate is no better than the exact one in any quantity, and rounds to itself.
TEST(GroundKind, RoundingIsConservative) {
  std::mt19937_64 random(3);
  const GroundClass ground{.soil = testSand()};
  for (int i = 0; i < 5000; ++i) {
    const GroundBelief belief = anyBelief(random);
    const GroundKind kind = GroundKind::of(kPrior, 0, 0, belief);
    const GroundBelief worst = kind.belief(kPrior, ground);
    // A difference of a millionth of a step is floating-point rounding.
    GroundBelief a_little_better = belief;
    a_little_better.pull.value += 1e-6;
    a_little_better.pull.std -= 1e-5;
    a_little_better.sinkage.value -= 1e-6;
    ASSERT_TRUE(noBetter(worst, a_little_better)) << i;
    ASSERT_EQ(GroundKind::of(kPrior, 0, 0, worst), kind);
  }
}

// Property: an estimate no worse than the prior of its class is rounded to a value no worse than the prior.
TEST(GroundKind, RoundingNeverFallsBelowThePrior) {
  std::mt19937_64 random(4);
  const GroundClass ground{.soil = testSand()};
  for (int i = 0; i < 2000; ++i) {
    const auto better = [&](double most) {
      return std::uniform_real_distribution<double>(0.0, most)(random);
    };
    const GroundBelief belief{.pull = {kPrior.pull.value + better(0.1), kPrior.pull.std - better(0.05)},
                              .sinkage = {kPrior.sinkage.value - better(0.2), 0.1}};
    ASSERT_TRUE(noBetter(kPrior, GroundKind::of(kPrior, 0, 0, belief).belief(kPrior, ground)));
  }
}

}  // namespace ground_kind_test
}  // namespace talus::costmap
