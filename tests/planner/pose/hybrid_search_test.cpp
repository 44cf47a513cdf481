#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <talus/planner/pose/hybrid_search.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace hybrid_search_test {

// Property: the table equals a map from cell and heading whose missing entries are infinite.
TEST(PoseTable, TableMatchesAMapKeyedByCellAndHeading) {
  constexpr std::size_t kCells = 300, kHeadings = 7;
  PoseTable table(kCells, kHeadings);
  std::map<std::pair<std::size_t, std::size_t>, float> expected;
  std::mt19937 random(6);
  int known = 0, unknown = 0;
  for (int k = 0; k < 5'000; ++k) {
    const std::pair key{random() % kCells, random() % kHeadings};
    const auto found = expected.find(key);
    const float value = table.at(key.first, key.second);
    ++(found == expected.end() ? unknown : known);
    if (found == expected.end())
      ASSERT_TRUE(std::isinf(value));
    else
      ASSERT_EQ(value, found->second);
    if (k % 3 == 0) table.at(key.first, key.second) = expected[key] = static_cast<float>(k);
  }
  EXPECT_GT(known, 1'000);
  EXPECT_GT(unknown, 1'000);
}

using testing::drawn;
using testing::randomMap;

constexpr MotionSet::Options kOptions{.headings = 72, .step_cells = 1.5, .offset_rad = 0.3};

// Property: the stated end of a motion is the end of its leg, in one of the set's headings; arcs keep the
// radius, and without reversing no motion goes backwards.
TEST(MotionSet, StatedMotionEndsMatchTheirLegs) {
  const auto map = drawn({".....", "....."});
  for (const double radius_m : {0.0, 0.7, 4.0})
    for (const bool reverse : {true, false}) {
      const MotionSet set(*map, {.turning_radius_m = radius_m, .may_reverse = reverse}, kOptions);
      int backwards = 0, turns = 0;
      for (int k = 0; k < set.headings(); ++k)
        for (const MotionSet::Motion& motion : set.from(k)) {
          const Pose end = after(Pose{{0.0, 0.0}, set.heading_rad(k)}, motion.leg);
          EXPECT_NEAR(end.place.x_m, motion.dx_m, 1e-12);
          EXPECT_NEAR(end.place.y_m, motion.dy_m, 1e-12);
          EXPECT_NEAR(std::remainder(end.heading_rad - set.heading_rad(motion.heading), 2 * std::numbers::pi),
                      0.0, 1e-9);
          if (radius_m > 0.0) {
            EXPECT_LE(std::abs(motion.leg.arc.curvature_1_m), 1 / radius_m + 1e-12);
            EXPECT_EQ(motion.leg.turn_rad, 0.0);
          }
          EXPECT_EQ(motion.direction, direction(motion.leg));
          backwards += motion.direction < 0;
          turns += motion.direction == 0;
        }
      EXPECT_EQ(backwards > 0, reverse);
      EXPECT_EQ(turns > 0, radius_m == 0.0);
    }
}

// Property: the quick cost is infinite off the map and over blocked ground. On rough ground it is close to
// the exact cost; it is sampled at intervals of half a cell.
TEST(MotionSet, QuickCostApproximatesTheExactCost) {
  const auto map = randomMap({.width = 30, .height = 30, .seed = 5, .blocked = 0.1, .roughness = 0.15});
  const MotionCost motion_cost(map);
  const Kinematics kinematics{.turning_radius_m = 2.0};
  const PoseCost exact(motion_cost, kinematics);
  const MotionSet set(*map, kinematics, kOptions);
  double quick_sum = 0.0, exact_sum = 0.0;
  int refused = 0;
  for (int n = 0; n < 200; ++n) {
    const maps::Point from{5.2 + n % 20, 4.7 + n / 10};
    for (const MotionSet::Motion& motion : set.from(n % 72)) {
      const double quick_J = set.quickCost(motion, from),
                   exact_J = exact({from, set.heading_rad(n % 72)}, motion.leg);
      refused += std::isinf(quick_J);
      if (!std::isfinite(exact_J)) continue;
      ASSERT_TRUE(std::isfinite(quick_J));  // every sampled cell is crossed by the exact motion
      quick_sum += quick_J;
      exact_sum += exact_J;
    }
  }
  EXPECT_GT(refused, 50);
  EXPECT_NEAR(quick_sum, exact_sum, 0.02 * exact_sum);
  // Closed form: half a cell from the western edge, every longer motion westwards leaves the map.
  const MotionSet straight(*map, kinematics, {.headings = 72, .step_cells = 1.5, .offset_rad = 0.0});
  for (const MotionSet::Motion& motion : straight.from(0))
    if (motion.dx_m < -0.9) {
      EXPECT_TRUE(std::isinf(straight.quickCost(motion, {0.5, 15.5})));
    }
}

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
  corner.kinematics = {.turning_radius_m = 0.0,
                       .turns = {.on_arc = {}, .in_place = {.energy_J = 1.0}, .at_vertex = {}}};
  const PosePlan plan = search.plan(corner);
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_GT(shape(plan.path).turns_in_place, 0);
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
