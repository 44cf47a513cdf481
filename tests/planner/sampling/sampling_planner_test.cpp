#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>
#include <refused.hpp>

#include <talus/planner/bench/slip_world.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/problem.hpp>
#include <talus/planner/sampling/map_space.hpp>
#include <talus/planner/sampling/sampling_planner.hpp>

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
namespace sampling_planner_test {

using ::testing::HasSubstr;

TEST(SamplingSettings, TextRoundTrips) {
  const SamplingSettings settings = samplingSettings("rrt*:range=20:cold:goal_bias=0.1");
  EXPECT_EQ(settings.planner, "RRTstar");
  EXPECT_TRUE(settings.cold);
  EXPECT_EQ(settings.parameters.at("range"), "20");
  EXPECT_EQ(wordsOf(settings), "RRTstar:cold:goal_bias=0.1:range=20");
  EXPECT_EQ(wordsOf(samplingSettings(wordsOf(settings))), wordsOf(settings));
  for (const std::string& name : plannerNames()) EXPECT_EQ(wordsOf(samplingSettings(name)), name);
  EXPECT_EQ(warmAndCold().size(), plannerNames().size() + 6);
  for (const std::string& words : warmAndCold()) EXPECT_EQ(wordsOf(samplingSettings(words)), words);
}

TEST(SamplingSettings, UnsupportedParametersAreRejectedByName) {
  const auto said = [](const std::string& words) -> std::string {
    try {
      samplingSettings(words);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(said("RRTstar:speed=3"), HasSubstr("no parameter 'speed'; it has "));
  EXPECT_THAT(said("RRTstar:range=far"), HasSubstr("range does not take 'far'"));
  EXPECT_THAT(said("RRTstar:warm"), HasSubstr("'warm' is neither cold nor NAME=VALUE"));
  EXPECT_THAT(said("field:cold"), HasSubstr("not an OMPL planner"));
  EXPECT_THAT(said("hybrid:range=2"), HasSubstr("not an OMPL planner"));
}

// Property: the first solution is the field's route, unless the option `cold` is set; parameters are passed
// to the planner.
TEST(SamplingSettings, ColdStartOmitsTheFieldRoute) {
  Problem problem{
      .map = testing::randomMap({.width = 40, .height = 40, .seed = 3, .blocked = 0.05, .roughness = 0.2}),
      .start = {3.5, 3.5},
      .goal = {36.5, 35.5},
      .prove = false};
  const double field_J = NamedPlanner().plan(problem).cost_J;
  const auto first_J = [&](const std::string& words) {
    NamedPlanner planner(words);
    double first = -1.0;
    planner.onBetter([&](double cost_J) { first = first < 0.0 ? cost_J : first; });
    EXPECT_EQ(planner.plan(problem).status, RouteStatus::Found) << words;
    return first;
  };
  EXPECT_EQ(first_J("RRTstar"), field_J);
  EXPECT_GT(first_J("RRTstar:cold"), field_J);
  EXPECT_NE(first_J("RRTstar:cold:range=2"), first_J("RRTstar:cold:range=30"));
}

using testing::drawn;

Problem onLevelGround() {
  return {.map = drawn(std::vector<std::string>(20, std::string(30, '.'))),
          .start = {3.5, 10.5},
          .goal = {26.5, 10.5}};
}

Plan straight(const Problem& leg) {
  Plan known;
  known.points = {leg.start, leg.goal};
  known.cost_J = MotionCost(leg.map).along(known.points);
  known.status = RouteStatus::Found;
  known.lower_bound_J = 200.0;
  return known;
}

// Closed form: on level ground the straight line, 23 m at 10 J/m, is optimal; a known lower bound is kept if
// it is higher than the straight-line bound.
TEST(OmplRun, BestRouteAndHigherBoundAreReturned) {
  const Problem leg = onLevelGround();
  const Plan plan = runOmpl(leg, {.planner = "RRTstar", .work = 100'000}, straight(leg));
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_NEAR(plan.cost_J, 230.0, 1e-4);
  EXPECT_NEAR(plan.lower_bound_J, 230.0, 1e-4);
  Plan bound = straight(leg);
  bound.lower_bound_J = 229.0;
  Problem near = leg;
  near.goal_tolerance_m = 5.0;  // the straight-line bound is 180 J now
  EXPECT_NEAR(runOmpl(near, {.planner = "RRTstar", .work = 100'000}, bound).lower_bound_J, 229.0, 1e-9);
}

TEST(OmplRun, FailureNamesWhatEndedTheSearch) {
  Problem leg = onLevelGround();
  std::vector<std::string> rows(20, std::string(30, '.'));
  for (auto& row : rows) row[15] = '#';
  leg.map = drawn(rows);
  const Plan worked = runOmpl(leg, {.planner = "RRTstar", .work = 50'000}, {});
  EXPECT_EQ(worked.status, RouteStatus::NoneFound);
  EXPECT_THAT(worked.reason, HasSubstr("within its work limit; planner 'field' decides"));
  EXPECT_TRUE(worked.points.empty());
  EXPECT_TRUE(std::isinf(worked.cost_J));
  leg.time_limit_s = 0.01;
  const Plan late = runOmpl(leg, {.planner = "RRTstar", .work = 50'000}, {});
  EXPECT_EQ(late.status, RouteStatus::TimedOut);
  EXPECT_THAT(late.reason, HasSubstr("within the time limit"));
}

// A wall with a gap near its south end that blocks the direct route from west to east.
std::shared_ptr<const costmap::CostGrid> wall() {
  std::vector<std::string> rows(40, std::string(60, '.'));
  for (std::size_t r = 0; r < 34; ++r) rows[r][30] = '#';
  return drawn(rows);
}

Problem across(std::shared_ptr<const costmap::CostGrid> map) {
  Problem problem;
  problem.map = std::move(map);
  problem.start = {5.5, 20.5};
  problem.goal = {54.5, 20.5};
  return problem;
}

// An initial-path provider that returns one route around the wall, not the best.
Plan detour(const Problem& leg) {
  Plan known;
  known.points = {leg.start, {15.5, 2.5}, {45.5, 2.5}, leg.goal};
  known.cost_J = MotionCost(leg.map).along(known.points);
  known.status = RouteStatus::Found;
  return known;
}

// The same map with a cost that forbids climbing.
std::shared_ptr<const costmap::CostGrid> drivenDownOnly(const std::shared_ptr<const costmap::CostGrid>& map) {
  const costmap::TravelCurve curve = testing::curveOf(
      [](double gradient) { return gradient > 0.0 ? std::numeric_limits<float>::infinity() : 10.0F; });
  auto content = map->content();
  content.cost = std::make_shared<costmap::TravelCost>(costmap::TravelCost::Limits{}, std::vector{curve});
  return std::make_shared<costmap::CostGrid>(content);
}

class EveryPlanner : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Ompl, EveryPlanner,
                         ::testing::Values("RRTstar", "InformedRRTstar", "BITstar", "ABITstar", "SST",
                                           "FMT"));

const std::string kLevel(20, '.');

TEST_P(EveryPlanner, PlanCostEqualsMotionCostAroundAWall) {
  const Problem problem = across(wall());
  const Plan plan = planBySampling(problem, {.planner = GetParam(), .work = 1'000'000});
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_EQ(plan.points.front(), problem.start);
  EXPECT_EQ(plan.points.back(), problem.goal);
  // Property: the plan's cost equals that of its points by the one cost function.
  EXPECT_DOUBLE_EQ(plan.cost_J, MotionCost(problem.map).along(plan.points));
  // Closed form: the shortest route passes the wall's south end, (30, 6) to (31, 6), at 10 J/m.
  const double best_J = 10 * (std::hypot(24.5, 14.5) + 1 + std::hypot(23.5, 14.5));
  EXPECT_GE(plan.cost_J, best_J * (1 - 1e-12));
  // Tolerance: asymptotically optimal planners stopped early; SST is near-optimal up to its pruning radius.
  EXPECT_LE(plan.cost_J, best_J * (GetParam() == "SST" ? 1.3 : 1.1));
  EXPECT_LE(plan.lower_bound_J, best_J);
}

TEST_P(EveryPlanner, KnownRouteIsImproved) {
  const Problem problem = across(wall());
  const double known_J = detour(problem).cost_J;
  const Plan plan = planBySampling(problem, {.planner = GetParam(), .work = 1'000'000}, detour);
  ASSERT_EQ(plan.status, RouteStatus::Found);
  EXPECT_LT(plan.cost_J, known_J);
}

TEST_P(EveryPlanner, SameSeedReproducesTheRoute) {
  Problem problem = across(wall());
  const SamplingSettings settings{.planner = GetParam(), .work = 1'000'000};
  const Plan first = planBySampling(problem, settings, detour);
  const Plan second = planBySampling(problem, settings, detour);
  EXPECT_EQ(first.points, second.points);
  problem.seed = 2;
  EXPECT_NE(planBySampling(problem, settings, detour).points, first.points);
}

// Property: a time limit is used up, even if the work limit would end the search earlier.
TEST_P(EveryPlanner, TimeLimitOverridesTheWorkLimit) {
  Problem problem = across(wall());
  problem.time_limit_s = 0.3;
  const Plan plan = planBySampling(problem, {.planner = GetParam(), .work = 1}, detour);
  EXPECT_EQ(plan.status, RouteStatus::Found);
  EXPECT_LT(plan.cost_J, detour(problem).cost_J);  // with a work limit of 1 the known route is unchanged
}

TEST_P(EveryPlanner, ForbiddenClimbsAreNeverUsed) {
  // Ground that rises eastwards and may only be driven down: no route exists from west to east.
  const auto map = drivenDownOnly(drawn(std::vector<std::string>(20, kLevel + ">>>>" + kLevel)));
  Problem up{.map = map, .start = {5.5, 10.5}, .goal = {38.5, 10.5}};
  Problem down{.map = map, .start = {38.5, 10.5}, .goal = {5.5, 10.5}};
  const SamplingSettings settings{.planner = GetParam(), .work = 1'000'000, .range_cells = 10};
  EXPECT_EQ(planBySampling(up, settings).status, RouteStatus::NoneFound);
  EXPECT_EQ(planBySampling(down, settings).status, RouteStatus::Found);
}

TEST_P(EveryPlanner, FieldProofOfNoRouteEndsTheSearch) {
  const auto walled = drawn(std::vector<std::string>(20, kLevel + "#" + kLevel));
  const Problem across{.map = walled, .start = {5.5, 10.5}, .goal = {38.5, 10.5}};
  const auto proof = [](const Problem& leg) { return FieldPlanner().plan(leg); };
  EXPECT_EQ(planBySampling(across, {.planner = GetParam()}, proof).status, RouteStatus::NoRoute);
}

TEST_P(EveryPlanner, StopYieldsCancelled) {
  std::stop_source stop;
  stop.request_stop();
  Problem problem = across(wall());
  problem.watch.stop = stop.get_token();
  EXPECT_EQ(planBySampling(problem, {.planner = GetParam()}).status, RouteStatus::Cancelled);
}

// Property: a route known at the time of a stop is returned.
TEST_P(EveryPlanner, StopReturnsTheBestRouteSoFar) {
  std::stop_source stop;
  Problem problem = across(wall());
  problem.watch.stop = stop.get_token();
  SamplingSettings settings{.planner = GetParam()};
  settings.better = [&stop](double) { stop.request_stop(); };  // called with the known route first
  const Plan plan = planBySampling(problem, settings, detour);
  EXPECT_EQ(plan.status, RouteStatus::Found);
  EXPECT_LE(MotionCost(problem.map).along(plan.points),
            MotionCost(problem.map).along(detour(problem).points));
}

TEST_P(EveryPlanner, BlockedStartAndGoalAreReported) {
  Problem problem = across(wall());
  problem.start = {30.5, 30.5};
  EXPECT_EQ(planBySampling(problem, {.planner = GetParam()}).status, RouteStatus::StartInvalid);
  problem = across(wall());
  problem.goal = {1000, 1000};
  EXPECT_EQ(planBySampling(problem, {.planner = GetParam()}).status, RouteStatus::GoalInvalid);
}

TEST_P(EveryPlanner, StartEqualToGoalCostsZero) {
  Problem problem = across(wall());
  problem.goal = problem.start;
  const Plan plan = planBySampling(problem, {.planner = GetParam(), .work = 10'000});
  EXPECT_EQ(plan.status, RouteStatus::Found);
  EXPECT_EQ(plan.cost_J, 0.0);
}

TEST_P(EveryPlanner, ViaPointsArePassedInOrder) {
  Problem problem = across(wall());
  problem.via = {{10.5, 35.5}, {50.5, 35.5}};
  const Plan plan = planBySampling(problem, {.planner = GetParam(), .work = 1'000'000});
  ASSERT_EQ(plan.status, RouteStatus::Found);
  const auto first = std::ranges::find(plan.points, problem.via[0]);
  const auto second = std::ranges::find(plan.points, problem.via[1]);
  ASSERT_NE(second, plan.points.end());
  EXPECT_LT(first, second);
}

// Property: the returned route costs no more than the reported cost, also if the given route turns on edges
// between cells and headings are forbidden cell by cell.
TEST(SamplingPlanner, ReturnedCostIsAtMostTheReportedCost) {
  for (const std::string name : {"RRTstar", "InformedRRTstar", "BITstar"})
    for (const std::uint64_t seed : {std::uint64_t{1001}, std::uint64_t{1002}}) {
      Problem problem{.map = slipWorld({.seed = seed}).map, .start = {8.5, 8.5}, .goal = {87.5, 87.5}};
      problem.prove = false;
      double reported_J = INFINITY;
      SamplingSettings settings{.planner = name, .work = 1'000'000};
      settings.better = [&reported_J](double cost_J) { reported_J = std::min(reported_J, cost_J); };
      const Plan plan =
          planBySampling(problem, settings, [](const Problem& leg) { return FieldPlanner().plan(leg); });
      ASSERT_EQ(plan.status, RouteStatus::Found);
      EXPECT_LE(plan.cost_J, reported_J * (1.0 + 1e-9)) << name << " seed " << seed;
    }
}

TEST(SamplingPlanner, SettingsOutOfRangeAreRejected) {
  EXPECT_REFUSED(planBySampling(across(wall()), {.work = 0}), std::invalid_argument, "work = 0, must be > 0");
  EXPECT_REFUSED(planBySampling(across(wall()), {.range_cells = -1}), std::invalid_argument,
                 "range_cells = -1.000000, must be > 0");
  EXPECT_REFUSED(planBySampling(across(wall()), {.planner = "field"}), std::invalid_argument,
                 "planner 'field' does not sample");
}

}  // namespace sampling_planner_test

}  // namespace talus::planner
