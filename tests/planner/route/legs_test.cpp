#include <vector>

#include <gtest/gtest.h>

#include <talus/planner/route/legs.hpp>

namespace talus::planner {
namespace {

Problem threeLegs() {
  Problem problem;
  problem.start = {0.0, 0.0};
  problem.via = {{1.0, 0.0}, {1.0, 1.0}};
  problem.goal = {2.0, 2.0};
  problem.goal_tolerance_m = 0.5;
  return problem;
}

TEST(Legs, EachBeginsWhereTheOneBeforeItEnded) {
  std::vector<Problem> asked;
  std::vector<double> progress;
  Problem problem = threeLegs();
  problem.watch.progress = [&](double done) { progress.push_back(done); };
  const Plan whole = planByLegs(problem, [&](const Problem& leg) {
    asked.push_back(leg);
    // The last leg stops short, as its tolerance lets it.
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

TEST(Legs, TheFirstThatIsNotFoundIsTheAnswer) {
  int calls = 0;
  const Plan whole = planByLegs(threeLegs(), [&](const Problem& leg) {
    if (++calls == 2) {
      Plan none;
      none.status = RouteStatus::NoRoute;
      none.reason = "a wall";
      return none;
    }
    return Plan{RouteStatus::Found, {}, {leg.start, leg.goal}, 1.0, 1.0};
  });
  EXPECT_EQ(whole.status, RouteStatus::NoRoute);
  EXPECT_EQ(whole.reason, "a wall");
  EXPECT_EQ(calls, 2);
}

}  // namespace
}  // namespace talus::planner
