#include <cmath>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <talus/common/common.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

namespace problem_test {

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
