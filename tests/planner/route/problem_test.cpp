#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <talus/common/common.hpp>
#include <talus/planner/route/problem.hpp>

#include "drawn_map.hpp"

namespace talus::planner {

namespace problem_test {

using testing::drawn;

TEST(PosePath, StraightLegCostEqualsMotionCost) {
  const MotionCost motion(drawn({"0123", "0123"}));
  const PoseCost cost(motion, {.turning_radius_m = 1.0});
  EXPECT_DOUBLE_EQ(cost({{0.5, 0.5}, 0.0}, {{3.0, 0.0}, 0.0}), motion({{0.5, 0.5}, {3.5, 0.5}}));
}

TEST(PosePath, ReverseCostEqualsDrivingInThatDirection) {
  const MotionCost motion(drawn({">>>>"}));
  const PoseCost cost(motion, {.turning_radius_m = 1.0});
  // A rover that faces east and reverses west goes downhill.
  EXPECT_DOUBLE_EQ(cost({{3.5, 0.5}, 0.0}, {{-3.0, 0.0}, 0.0}), motion({{3.5, 0.5}, {0.5, 0.5}}));
}

TEST(PosePath, ArcCostOnUniformGroundIsLengthPlusTurn) {
  const MotionCost motion(drawn({"....", "....", "....", "...."}));
  const PoseCost cost(motion, {.turning_radius_m = 2.0,
                               .turns = {.on_arc = {.energy_J = 7.0}, .in_place = {}, .at_vertex = {}}});
  // Closed form: 10 J/m; chords of 0.1 rad are shorter than their arc by 0.1^2/24.
  EXPECT_NEAR(cost({{0.5, 0.5}, 0.0}, {{std::numbers::pi, 0.5}, 0.0}),
              10.0 * std::numbers::pi + 7.0 * std::numbers::pi / 2, 10.0 * std::numbers::pi * 5e-4);
}

TEST(PosePath, TurnInPlaceRequiresEveryHeading) {
  // The steep cell may be crossed east and west at 0.2; a cross limit of 0.1 forbids the heading north.
  const auto steep = testing::drawn({">"});
  const costmap::CostGrid grid({.grid = steep->grid(),
                                .tiles = steep->content().tiles,
                                .cost = testing::driveCost({.max_along = 0.3, .max_across = 0.1}),
                                .version = 1});
  const MotionCost motion(std::make_shared<const costmap::CostGrid>(grid));
  const PoseCost cost(motion, {.turns = {.on_arc = {}, .in_place = {.energy_J = 3.0}, .at_vertex = {}}});
  EXPECT_TRUE(std::isinf(cost({{0.5, 0.5}, 0.0}, {{}, std::numbers::pi / 2})));
  EXPECT_DOUBLE_EQ(cost({{0.5, 0.5}, 0.0}, {{}, 0.2}), 0.6);
}

TEST(PosePath, CuspsAreCountedAndPriced) {
  const MotionCost motion(drawn({"....."}));
  const PoseCost cost(motion, {.turning_radius_m = 1.0, .cusp = {.energy_J = 5.0}});
  const PosePath path{.start = {{1.5, 0.5}, 0.0}, .legs = {{{2.0, 0.0}, 0.0}, {{-1.0, 0.0}, 0.0}}};
  EXPECT_EQ(shape(path).cusps, 1);
  EXPECT_NEAR(cost(path), 35.0, 1e-6);
}

TEST(PosePath, SamplesEndAtTheDriveEnd) {
  const PosePath path{.start = {{0.0, 0.0}, 0.0},
                      .legs = {{{std::numbers::pi, 0.5}, 0.0}, {{}, 1.0}, {{1.0, 0.0}, 0.0}}};
  const auto poses = sampled(path, 0.1);
  Pose end = path.start;
  for (const auto& leg : path.legs) end = after(end, leg);
  EXPECT_NEAR(poses.back().place.x_m, end.place.x_m, 1e-9);
  EXPECT_NEAR(poses.back().heading_rad, end.heading_rad, 1e-9);
  for (std::size_t k = 1; k < poses.size(); ++k)
    EXPECT_LE(
        std::hypot(poses[k].place.x_m - poses[k - 1].place.x_m, poses[k].place.y_m - poses[k - 1].place.y_m),
        0.1 + 1e-9);
}

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(PlannerNames, SpellingVariantsAreAccepted) {
  EXPECT_EQ(plannerName(""), "field");
  EXPECT_EQ(plannerName("RRT*"), "RRTstar");
  EXPECT_EQ(plannerName("informed-rrt*"), "InformedRRTstar");
  EXPECT_EQ(plannerName("bit_star"), "BITstar");
  EXPECT_EQ(plannerName("ABIT*"), "ABITstar");
  for (const std::string& name : plannerNames()) EXPECT_EQ(plannerName(name), name);
}

TEST(PlannerNames, UnsupportedPlannerIsRejectedWithItsReason) {
  EXPECT_THAT([] { plannerName("PRM*"); }, ThrowsMessage<std::invalid_argument>(
                                               AllOf(HasSubstr("PRMstar"), HasSubstr("both directions"))));
  for (const char* name : {"PRM*", "LazyPRM*", "SPARS", "BFMT", "LBTRRT", "AIT*", "RRTConnect"})
    EXPECT_THAT([&] { plannerName(name); }, ThrowsMessage<std::invalid_argument>(HasSubstr("is refused: ")))
        << name;
}

TEST(PlannerNames, UnknownPlannerSuggestsTheNearestName) {
  EXPECT_THAT([] { plannerName("feild"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("nearest is 'field'")));
  EXPECT_THAT([] { plannerName("BITsta"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("nearest is 'BITstar'")));
}

// Property: a stop request takes precedence over an elapsed time limit.
TEST(PlanEnd, StoppedPlanNamesItsCause) {
  std::stop_source source;
  const StopCheck late(ProgressMonitor{.progress = {}, .stop = source.get_token()}, 0.0);
  const Plan timed_out = cancelledPlan(late);
  EXPECT_EQ(timed_out.status, RouteStatus::TimedOut);
  EXPECT_THAT(timed_out.reason, ::testing::HasSubstr("time limit"));
  source.request_stop();
  const Plan cancelled = cancelledPlan(late);
  EXPECT_EQ(cancelled.status, RouteStatus::Cancelled);
  EXPECT_THAT(cancelled.reason, ::testing::HasSubstr("cancelled"));
}

Problem threeLegs() {
  Problem problem;
  problem.start = {0.0, 0.0};
  problem.via = {{1.0, 0.0}, {1.0, 1.0}};
  problem.goal = {2.0, 2.0};
  problem.goal_tolerance_m = 0.5;
  return problem;
}

TEST(Legs, EachLegStartsAtTheEndOfThePreviousLeg) {
  std::vector<Problem> asked;
  std::vector<double> progress;
  Problem problem = threeLegs();
  problem.watch.progress = [&](double done) { progress.push_back(done); };
  const Plan whole = planByLegs(problem, [&](const Problem& leg) {
    asked.push_back(leg);
    // The last leg ends within its tolerance, short of the goal.
    const maps::Point end = asked.size() == 3 ? maps::Point{1.8, 1.8} : leg.goal;
    return Plan{RouteStatus::Found, {}, {leg.start, end}, 10.0, 7.0};
  });
  ASSERT_EQ(asked.size(), 3U);
  for (const Problem& leg : asked) EXPECT_TRUE(leg.via.empty());
  EXPECT_EQ(asked[1].start, problem.via[0]);
  EXPECT_EQ(asked[2].start, problem.via[1]);
  EXPECT_EQ(asked[2].goal, problem.goal);
  EXPECT_EQ(asked[0].goal_tolerance_m, 0.0);  // a via point is met exactly
  EXPECT_EQ(asked[2].goal_tolerance_m, 0.5);
  EXPECT_EQ(whole.points, (std::vector<maps::Point>{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {1.8, 1.8}}));
  EXPECT_EQ(whole.cost_J, 30.0);
  EXPECT_EQ(whole.lower_bound_J, 21.0);
  ASSERT_FALSE(progress.empty());
  EXPECT_EQ(progress.back(), 1.0);
}

// Property: if a leg fails at one of its ends, a via point is named by its number, because the user's start
// and goal are others.
TEST(Legs, FailingViaPointIsNamedByItsNumber) {
  const auto reason = [](int failing, const char* why) {
    int calls = 0;
    return planByLegs(threeLegs(),
                      [&](const Problem& leg) {
                        Plan part{RouteStatus::Found, {}, {leg.start, leg.goal}, 1.0, 1.0};
                        if (++calls != failing) return part;
                        part.status = RouteStatus::GoalInvalid;
                        part.reason = why;
                        return part;
                      })
        .reason;
  };
  EXPECT_EQ(reason(1, "start 0,0 lies outside the map"), "start 0,0 lies outside the map");
  EXPECT_EQ(reason(1, "goal 1,0 lies outside the map"), "via point 1 1,0 lies outside the map");
  EXPECT_EQ(reason(2, "start 1,0 lies outside the map"), "via point 1 1,0 lies outside the map");
  EXPECT_EQ(reason(2, "goal 1,1 lies outside the map"), "via point 2 1,1 lies outside the map");
  EXPECT_EQ(reason(3, "goal 2,2 lies outside the map"), "goal 2,2 lies outside the map");
}

}  // namespace problem_test

}  // namespace talus::planner
