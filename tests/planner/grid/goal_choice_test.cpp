#include <cmath>
#include <string>
#include <vector>

#include <talus/planner/grid/goal_choice.hpp>
#include <talus/planner/plan/named_planner.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace goal_choice_test {

using testing::drawn;
using testing::randomMap;

std::vector<maps::Point> goalsOf(const Problem& problem) {
  std::vector<maps::Point> goals{problem.goal};
  goals.insert(goals.end(), problem.other_goals.begin(), problem.other_goals.end());
  return goals;
}

// Property: the result is the cheapest of the plans to each goal alone, for every kind of planner, with and
// without a via point; its lower bound is valid for each of these plans.
TEST(GoalChoice, ResultIsTheCheapestOfTheSingleGoalPlans) {
  int not_the_first = 0;
  for (const std::string planner : {"field", "hybrid", "RRTstar"})
    for (unsigned seed = 1; seed <= (planner == "RRTstar" ? 1 : 6); ++seed) {  // sampling is slow
      Problem problem{.map = randomMap({.width = 40, .height = 40, .seed = seed, .blocked = 0.05}),
                      .start = {20.5, 20.5},
                      .goal = {3.5, 4.5},
                      .other_goals = {{36.5, 5.5}, {20.5, 33.5}, {8.5, 30.5}},
                      .prove = true,
                      .kinematics = {.turning_radius_m = 1.5}};
      if (seed % 2 == 0) problem.via = {{25.5, 25.5}};
      const Plan any = NamedPlanner(planner).plan(problem);
      double best_J = INFINITY;
      std::size_t best = 0;
      const auto goals = goalsOf(problem);
      for (std::size_t k = 0; k < goals.size(); ++k) {
        Problem one = problem;
        one.other_goals.clear();
        one.goal = goals[k];
        const Plan plan = NamedPlanner(planner).plan(one);
        if (plan.status == RouteStatus::Found && plan.cost_J < best_J) best_J = plan.cost_J, best = k;
      }
      if (std::isinf(best_J)) {
        EXPECT_NE(any.status, RouteStatus::Found);
        continue;
      }
      ASSERT_EQ(any.status, RouteStatus::Found) << planner << " seed " << seed << ": " << any.reason;
      EXPECT_EQ(any.cost_J, best_J) << planner << " seed " << seed;
      EXPECT_EQ(any.goal, best) << planner << " seed " << seed;
      const maps::Point end = any.points.back(), goal = goals[any.goal];
      EXPECT_NEAR(std::hypot(end.x_m - goal.x_m, end.y_m - goal.y_m), 0.0, 1e-9);
      EXPECT_LE(any.lower_bound_J, any.cost_J);
      EXPECT_GT(any.lower_bound_J, 0.0);
      not_the_first += best != 0;
    }
  EXPECT_GT(not_the_first, 4);
}

TEST(GoalChoice, UnreachableGoalsAreSkipped) {
  const auto map = drawn({"..........", "..#####...", "..#.#.....", "..###.....", ".........."});
  Problem problem{
      .map = map, .start = {1.5, 2.5}, .goal = {3.5, 2.5}, .other_goals = {{2.5, 2.5}, {8.5, 2.5}}};
  const Plan plan = NamedPlanner().plan(problem);
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_EQ(plan.goal, 2u);

  problem.other_goals = {{2.5, 2.5}};
  EXPECT_EQ(NamedPlanner().plan(problem).status, RouteStatus::GoalInvalid);  // the status of the nearest goal
  problem.start = {2.5, 1.5};
  EXPECT_EQ(NamedPlanner().plan(problem).status, RouteStatus::StartInvalid);
}

TEST(GoalChoice, GoalsThatCannotBeCheaperAreNotPlanned) {
  Problem problem{.map = drawn({"............................................................"}),
                  .start = {1.5, 0.5},
                  .goal = {55.5, 0.5},
                  .other_goals = {{3.5, 0.5}}};
  std::vector<maps::Point> asked;
  const Plan plan = planToCheapest(problem, [&](const Problem& one) {
    asked.push_back(one.goal);
    return NamedPlanner().plan(one);
  });
  EXPECT_EQ(plan.goal, 1u);
  EXPECT_EQ(asked, (std::vector<maps::Point>{{3.5, 0.5}}));  // 54 m cost more than 2 m on any ground
}

TEST(GoalChoice, StopsOnRequest) {
  std::stop_source stop;
  Problem problem{
      .map = drawn({"....", "...."}), .start = {0.5, 0.5}, .goal = {3.5, 1.5}, .other_goals = {{2.5, 0.5}}};
  problem.watch.stop = stop.get_token();
  int asked = 0;
  const Plan plan = planToCheapest(problem, [&](const Problem& one) {
    ++asked;
    stop.request_stop();
    return NamedPlanner().plan(one);
  });
  EXPECT_EQ(plan.status, RouteStatus::Cancelled);
  EXPECT_EQ(asked, 1);
}

}  // namespace goal_choice_test
}  // namespace talus::planner
