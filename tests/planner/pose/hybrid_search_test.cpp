#include <cmath>
#include <numbers>

#include <talus/planner/pose/hybrid_search.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace hybrid_search_test {

using testing::drawn;
using testing::randomMap;

std::vector<std::string> room(int width, int height) {
  return std::vector<std::string>(static_cast<std::size_t>(height),
                                  std::string(static_cast<std::size_t>(width), '.'));
}

PoseProblem problem(std::shared_ptr<const costmap::CostGrid> map) {
  return {.map = std::move(map),
          .start = {1.5, 1.5},
          .goal = {17.5, 1.5},
          .kinematics = {.turning_radius_m = 2.0}};
}

Pose end(const PosePath& path) {
  Pose pose = path.start;
  for (const auto& leg : path.legs) pose = after(pose, leg);
  return pose;
}

TEST(HybridSearch, StraightGoalYieldsAStraightDrive) {
  HybridSearch search;
  auto ahead = problem(drawn(room(20, 5)));
  ahead.start_heading_rad = 0.0;
  const PosePlan plan = search.plan(ahead);
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_NEAR(plan.cost_J, 160.0, 1e-6);  // Closed form: 16 m at 10 J/m.
  EXPECT_EQ(shape(plan.path).cusps, 0);
}

TEST(HybridSearch, GoalHeadingIsReached) {
  HybridSearch search;
  auto turned = problem(drawn(room(20, 12)));
  turned.start = {3.5, 6.5};
  turned.start_heading_rad = 0.0;
  turned.goal_heading_rad = std::numbers::pi;
  turned.goal = {15.5, 6.5};
  for (const bool reverse : {true, false}) {
    turned.kinematics.may_reverse = reverse;
    const PosePlan plan = search.plan(turned);
    ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
    const Pose last = end(plan.path);
    EXPECT_NEAR(last.place.x_m, 15.5, 1e-6);
    EXPECT_NEAR(last.place.y_m, 6.5, 1e-6);
    EXPECT_NEAR(std::remainder(last.heading_rad - std::numbers::pi, 2 * std::numbers::pi), 0.0, 1e-6);
    EXPECT_LE(shape(plan.path).max_curvature_1_m, 0.5 + 1e-9);
    if (!reverse) {
      EXPECT_EQ(shape(plan.path).cusps, 0);
    }
  }
}

TEST(HybridSearch, DeadEndIsLeftOnlyInReverse) {
  // A corridor one cell wide; the rover faces its closed end.
  HybridSearch search;
  auto dead_end = problem(drawn({"######", "#....#", "######"}));
  dead_end.start = {4.5, 1.5};
  dead_end.goal = {1.5, 1.5};
  dead_end.start_heading_rad = 0.0;
  const PosePlan backed = search.plan(dead_end);
  ASSERT_EQ(backed.status, RouteStatus::Found) << backed.reason;
  EXPECT_NEAR(backed.cost_J, 30.0, 1e-6);
  dead_end.kinematics.may_reverse = false;
  EXPECT_EQ(search.plan(dead_end).status, RouteStatus::NoneFound);
}

TEST(HybridSearch, TurningInPlaceNegotiatesNarrowCorners) {
  HybridSearch search;
  auto corner = problem(drawn({"#####", "#...#", "#.#.#", "#.#.#", "#####"}));
  corner.start = {1.5, 1.5};
  corner.goal = {3.5, 1.5};
  corner.kinematics = {.turning_radius_m = 0.0, .turns = {.on_arc = {}, .in_place = {.cost_J = 1.0}}};
  const PosePlan plan = search.plan(corner);
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_GT(shape(plan.path).turns_in_place, 0);
}

TEST(HybridSearch, DriveCostMatchesDenseEvaluation) {
  // Property: on random sloping maps the stated cost of each drive equals its cost in steps of a tenth of a
  // cell; the drive never enters refused ground and keeps the turning radius.
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto map = randomMap({.width = 40, .height = 40, .seed = seed, .blocked = 0.08, .roughness = 0.15});
    auto asked = problem(map);
    asked.goal = {37.5, 35.5};
    HybridSearch search;
    const PosePlan plan = search.plan(asked);
    if (plan.status != RouteStatus::Found) continue;
    const MotionCost cost(map);
    double dense = 0.0;
    const auto poses = sampled(plan.path, 0.1);
    for (std::size_t k = 1; k < poses.size(); ++k) dense += cost({poses[k - 1].place, poses[k].place});
    EXPECT_NEAR(dense, plan.cost_J, 0.01 * plan.cost_J) << "seed " << seed;
    EXPECT_LE(shape(plan.path).max_curvature_1_m, 0.5 + 1e-9);
    EXPECT_DOUBLE_EQ(HybridSearch().plan(asked).cost_J, plan.cost_J);  // the same again
  }
}

TEST(HybridSearch, SearchIsRefinedBeforeReportingFailure) {
  // Property: a drive found with more headings and shorter motions is also found with the default settings.
  int found = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    auto asked =
        problem(randomMap({.width = 20, .height = 20, .seed = seed, .blocked = 0.15, .roughness = 0.15}));
    asked.start = {2.5, 2.5};
    asked.goal = {17.5, 16.5};
    asked.kinematics.turning_radius_m = 3.0;
    asked.start_heading_rad = 0.4 * seed;
    asked.goal_heading_rad = 1.7 * seed;
    if (HybridSearch({.headings = 144, .step_cells = 1.0}).plan(asked).status != RouteStatus::Found) continue;
    EXPECT_EQ(HybridSearch().plan(asked).status, RouteStatus::Found) << "seed " << seed;
    ++found;
  }
  EXPECT_GT(found, 10);
}

TEST(HybridSearch, HeuristicWeightTradesCostForExpansions) {
  // Property: a larger heuristic weight expands fewer poses and gives a more expensive drive.
  std::uint64_t expanded = 0, hasty_expanded = 0;
  double cost_J = 0.0, hasty_cost_J = 0.0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    auto asked =
        problem(randomMap({.width = 40, .height = 40, .seed = seed, .blocked = 0.08, .roughness = 0.15}));
    asked.goal = {37.5, 35.5};
    asked.kinematics.turning_radius_m = 4.0;
    asked.start_heading_rad = 3.0;
    asked.goal_heading_rad = -2.0;
    const PosePlan plan = HybridSearch().plan(asked);
    const PosePlan hasty = HybridSearch({.suboptimality_bound = 1.5, .improve = 0}).plan(asked);
    ASSERT_EQ(plan.status, hasty.status);
    expanded += plan.expanded, hasty_expanded += hasty.expanded;
    cost_J += plan.cost_J, hasty_cost_J += hasty.cost_J;
  }
  EXPECT_GT(expanded, 2 * hasty_expanded);
  EXPECT_LT(cost_J, 0.95 * hasty_cost_J);
}

TEST(HybridSearch, InvalidStartAndGoalAreReported) {
  HybridSearch search;
  auto outside = problem(drawn(room(20, 5)));
  outside.start = {-1.0, 0.0};
  EXPECT_EQ(search.plan(outside).status, RouteStatus::StartInvalid);
  outside = problem(drawn(room(20, 5)));
  outside.goal = {100.0, 0.0};
  EXPECT_EQ(search.plan(outside).status, RouteStatus::GoalInvalid);
}

}  // namespace hybrid_search_test
}  // namespace talus::planner
