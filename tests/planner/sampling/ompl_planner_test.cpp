#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/route/problem.hpp>
#include <talus/planner/sampling/map_space.hpp>
#include <talus/planner/sampling/ompl_planner.hpp>

#include "drawn_map.hpp"
#include "ompl_ground.hpp"

namespace talus::planner {

namespace ompl_planner_test {

class Counter : public ompl::msg::OutputHandler {
 public:
  void log(const std::string&, ompl::msg::LogLevel, const char*, int) override { ++lines; }
  int lines = 0;
};

// Property: OMPL is silent while any guard exists, with any nesting; afterwards the host's handler is
// restored.
TEST(OmplGuard, HostOutputHandlerIsRestored) {
  Counter counter;
  ompl::msg::OutputHandler* const host = ompl::msg::getOutputHandler();
  ompl::msg::useOutputHandler(&counter);
  OMPL_WARN("before");
  EXPECT_EQ(counter.lines, 1);
  {
    const QuietOmpl outer;
    OMPL_WARN("within");
    { const QuietOmpl inner; }
    OMPL_WARN("still within");
    EXPECT_EQ(counter.lines, 1);
  }
  OMPL_WARN("after");
  EXPECT_EQ(counter.lines, 2);
  ompl::msg::useOutputHandler(host);
}

std::vector<double> drawnWith(std::uint64_t seed) {
  std::vector<double> numbers;
  withOmplSeed(seed, [&] {
    ompl::RNG generator;
    for (int k = 0; k < 8; ++k) numbers.push_back(generator.uniform01());
  });
  return numbers;
}

// Property: the random numbers depend on the seed only, not on earlier draws. Seeds above 32 bits and zero,
// which OMPL ignores, are valid.
TEST(OmplGuard, RandomNumbersDependOnTheSeedOnly) {
  const auto first = drawnWith(1);
  EXPECT_NE(first, drawnWith(2));
  EXPECT_EQ(first, drawnWith(1));
  EXPECT_EQ(drawnWith(0), drawnWith(0));
  EXPECT_NE(drawnWith(0), first);
  EXPECT_NE(drawnWith(std::uint64_t{1} << 40), first);
  EXPECT_THROW(withOmplSeed(1, [] { throw std::runtime_error("made nothing"); }), std::runtime_error);
  EXPECT_EQ(first, drawnWith(1));  // the seed is not locked
}

namespace ob = ompl::base;

const Segment kEnds{{2.5, 10.5}, {27.5, 10.5}};

// Cost of the solution of a planner with this seed route after a number of iterations.
double costAfter(int rounds, const SeededRRTstar::Seed& seed) {
  const QuietOmpl quiet;
  const testing::OmplGround ground(testing::drawn(std::vector<std::string>(20, std::string(30, '.'))), kEnds);
  double cost_J = INFINITY;
  withOmplSeed(1, [&] {
    SeededRRTstar planner(ground.space, seed);
    planner.setRange(8.0);
    planner.setProblemDefinition(ground.definition);
    planner.setup();
    int round = 0;
    planner.solve(ob::PlannerTerminationCondition([&] { return round++ >= rounds; }));
    const auto path = ground.definition->getSolutionPath();
    if (path && ground.definition->hasExactSolution())
      cost_J = path->cost(ground.definition->getOptimizationObjective()).value();
  });
  return cost_J;
}

// Closed form: the seed's three legs at 10 J/m are the first solution; the cost never increases, and
// decreases with time.
TEST(SeededRRTstar, SeedRouteIsAvailableImmediatelyAndImproved) {
  const std::vector<maps::Point> known{kEnds.from, {10.5, 18.5}, {20.5, 3.5}, kEnds.to};
  double seed_J = 0.0;
  for (std::size_t i = 1; i < known.size(); ++i)
    seed_J += 10.0 * std::hypot(known[i].x_m - known[i - 1].x_m, known[i].y_m - known[i - 1].y_m);
  for (const bool informed : {false, true}) {
    const SeededRRTstar::Seed seed{.route = known, .spacing_m = 2.0, .informed = informed};
    EXPECT_NEAR(costAfter(1, seed), seed_J, 0.01 * seed_J);
    const double improved_J = costAfter(2'000, seed);
    EXPECT_LT(improved_J, 0.9 * seed_J);
    EXPECT_GE(improved_J, 250.0 - 1e-3);  // the straight line
  }
  EXPECT_TRUE(std::isinf(costAfter(1, {})));  // without a seed nothing is known yet
}

// Property: a seed that does not reach the goal is extended, and is no solution.
TEST(SeededRRTstar, SeedThatMissesTheGoalIsNoSolution) {
  EXPECT_TRUE(std::isinf(costAfter(1, {.route = {kEnds.from, {20.5, 10.5}}, .spacing_m = 2.0})));
}

// Property: exactly the names of OMPL's planners create an OMPL planner, with the given problem and range.
TEST(OmplPlanner, CreatesExactlyTheOmplPlanners) {
  const QuietOmpl quiet;
  const testing::OmplGround ground(testing::drawn(std::vector<std::string>(20, std::string(30, '.'))), kEnds);
  int made = 0;
  for (const std::string& name : plannerNames()) {
    const auto planner = makeOmplPlanner(
        name, {.space = ground.space, .definition = ground.definition, .known_route = {}, .range_m = 7.0});
    if (!planner) continue;
    ++made;
    EXPECT_EQ(planner->getProblemDefinition(), ground.definition) << name;
    if (planner->params().hasParam("range")) {
      EXPECT_EQ(std::stod(planner->params()["range"].getValue()), 7.0) << name;
    }
  }
  EXPECT_EQ(made, 6);
  EXPECT_EQ(makeOmplPlanner("field", {.space = ground.space, .definition = ground.definition}), nullptr);
}

// Property: FMT* restarts until it is stopped, because its first samples miss a gap of one cell in a wall of
// 80.
TEST(OmplPlanner, FmtRestartsUntilItFindsANarrowGap) {
  const QuietOmpl quiet;
  std::vector<std::string> rows(80, std::string(120, '.'));
  for (std::size_t r = 0; r < 79; ++r) rows[r][60] = '#';
  const testing::OmplGround ground(testing::drawn(rows), {{10.5, 60.5}, {110.5, 60.5}});
  const auto planner = makeOmplPlanner(
      "FMT", {.space = ground.space, .definition = ground.definition, .known_route = {}, .range_m = 7.0});
  ASSERT_TRUE(planner);
  int rounds = 0;
  planner->solve(ompl::base::PlannerTerminationCondition(
      [&] { return ground.definition->hasExactSolution() || ++rounds > 400'000; }));
  EXPECT_TRUE(ground.definition->hasExactSolution());
}

}  // namespace ompl_planner_test

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
