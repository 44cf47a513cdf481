#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/geometric/PathGeometric.h>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/sampling/field_ompl_planner.hpp>
#include <talus/planner/sampling/map_space.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace field_ompl_planner_test {

namespace ob = ompl::base;
namespace og = ompl::geometric;

struct Asked {
  explicit Asked(const std::shared_ptr<const costmap::CostGrid>& map)
      : space(std::make_shared<MapSpace>(map->grid())), info(std::make_shared<ob::SpaceInformation>(space)) {
    const auto cost = std::make_shared<MeteredCost>(map, Segment{});
    info->setStateValidityChecker(std::make_shared<MapValidityChecker>(info, cost));
    info->setMotionValidator(std::make_shared<MapMotionValidator>(info, cost));
    info->setup();
  }

  ob::ProblemDefinitionPtr from(maps::Point start, maps::Point goal) const {
    auto definition = std::make_shared<ob::ProblemDefinition>(info);
    ob::ScopedState<> a(info), b(info);
    MapSpace::setPlace(a.get(), start);
    MapSpace::setPlace(b.get(), goal);
    definition->setStartAndGoalStates(a, b);
    return definition;
  }

  std::shared_ptr<MapSpace> space;
  ob::SpaceInformationPtr info;
};

TEST(FieldOmplPlanner, SolutionIsTheRouteOfTheField) {
  const auto map = testing::drawn({".......", "..###..", "....#..", "....#..", "......."});
  const Asked asked(map);
  const auto definition = asked.from({3.5, 1.5}, {5.5, 2.5});
  FieldOmplPlanner planner(asked.info, map);
  planner.setProblemDefinition(definition);
  planner.setup();
  ASSERT_EQ(planner.solve(ob::plannerNonTerminatingCondition()), ob::PlannerStatus::EXACT_SOLUTION);
  const auto* path = definition->getSolutionPath()->as<og::PathGeometric>();
  std::vector<maps::Point> points;
  for (unsigned i = 0; i < path->getStateCount(); ++i) points.push_back(MapSpace::place(path->getState(i)));
  EXPECT_TRUE(violations(*map, points).empty());
  Problem problem{.map = map, .start = {3.5, 1.5}, .goal = {5.5, 2.5}};
  EXPECT_EQ(points, FieldPlanner().plan(problem).points);
}

TEST(FieldOmplPlanner, UnsolvableAndInvalidProblemsAreReported) {
  const auto map = testing::drawn({"..#..", "..#.."});
  const Asked asked(map);
  FieldOmplPlanner planner(asked.info, map);
  planner.setProblemDefinition(asked.from({0.5, 0.5}, {4.5, 0.5}));
  planner.setup();
  EXPECT_FALSE(bool(planner.solve(ob::plannerNonTerminatingCondition())));
  planner.setProblemDefinition(asked.from({2.5, 0.5}, {4.5, 0.5}));
  EXPECT_EQ(planner.solve(ob::plannerNonTerminatingCondition()), ob::PlannerStatus::INVALID_START);
}

}  // namespace field_ompl_planner_test
}  // namespace talus::planner
