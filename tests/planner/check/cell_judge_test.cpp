#include <cmath>
#include <random>
#include <stdexcept>

#include <talus/common/common.hpp>
#include <talus/planner/check/route_check.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace cell_judge_test {

using Kind = CellJudgement::Kind;

CellJudgement judged(const costmap::CellCode::Parts& parts, costmap::TravelCost::Limits limits = {}) {
  return CellJudge(testing::driveCost(limits)).of(costmap::CellCode(parts));
}

TEST(CellJudge, MostExpensiveHeadingOnAPlaneIsUphill) {
  const double g = 0.125;  // a node of the table
  const CellJudgement hill = judged({.dz_dx = g, .curve = 0});
  EXPECT_EQ(hill.kind, Kind::Open);
  EXPECT_NEAR(hill.highest_J_per_m, 10.0 + 100.0 * g + 400.0 * g * g, 1e-4);  // Closed form
  EXPECT_NEAR(judged({.curve = 2}).highest_J_per_m, 30.0, 1e-4);              // Closed form: level
  EXPECT_NEAR(CellJudge(testing::driveCost()).level_J_per_m(), 10.0, 1e-4);   // Closed form: curve 0
}

TEST(CellJudge, KindFollowsFromRefusedHeadings) {
  EXPECT_EQ(judged({.curve = costmap::CellCode::kUnknown}).kind, Kind::Unknown);
  EXPECT_EQ(judged({.curve = costmap::CellCode::kBlocked}).kind, Kind::Refused);
  // Slope 0.33 with limits of 0.28 along and 0.17 across: every heading violates one of the limits.
  EXPECT_EQ(judged({.dz_dx = 0.33, .curve = 0}, {.max_along = 0.28, .max_across = 0.17}).kind, Kind::Refused);
  EXPECT_EQ(judged({.dz_dx = 0.3, .curve = 0}, {.max_along = 0.28, .max_across = 0.36}).kind,
            Kind::Restricted);
  EXPECT_TRUE(std::isinf(judged({.dz_dx = 0.3, .curve = 0}, {.max_along = 0.28}).highest_J_per_m));
  EXPECT_THROW(CellJudge(nullptr), std::invalid_argument);
}

// Closed form, by brute force: 720 headings of random cells, each evaluated separately.
TEST(CellJudge, MatchesBruteForceOverHeadings) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> gradient(-0.3, 0.3);
  const auto cost = testing::driveCost({.max_along = 0.28, .max_across = 0.17});
  CellJudge judge(cost);
  int kinds[4] = {};
  for (int k = 0; k < 500; ++k) {
    const costmap::CellCode cell({.dz_dx = gradient(random), .dz_dy = gradient(random), .curve = 3});
    const CellJudgement judgement = judge.of(cell);
    ++kinds[static_cast<int>(judgement.kind)];
    int allowed = 0;
    float highest = 0.0F;
    for (int drawn = 0; drawn < 720; ++drawn) {
      const double heading = drawn * 0.5 * kDegree;
      const float each = cost->costPerMetre(cell, {std::cos(heading), std::sin(heading)});
      allowed += std::isfinite(each) ? 1 : 0;
      highest = std::fmax(highest, each);
    }
    EXPECT_EQ(judgement.kind == Kind::Open, allowed == 720);
    EXPECT_TRUE(allowed == 0 || judgement.kind != Kind::Refused);
    // The most expensive of 64 headings is off by at most half their spacing: 1 - cos(pi / 64) = 0.12 % of
    // the gradients.
    if (judgement.kind != Kind::Open) continue;
    EXPECT_NEAR(judgement.highest_J_per_m / highest, 1.0F, 0.005F);
  }
  EXPECT_GT(kinds[1], 20);
  EXPECT_GT(kinds[2], 20);
  EXPECT_GT(kinds[3], 20);
}

}  // namespace cell_judge_test
}  // namespace talus::planner
