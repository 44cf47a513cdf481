#include <talus/planner/route/planner_names.hpp>
#include <talus/planner/sampling/ompl_guard.hpp>
#include <talus/planner/sampling/ompl_planner.hpp>

#include "drawn_map.hpp"
#include "ompl_ground.hpp"

namespace talus::planner {
namespace ompl_planner_test {

const Segment kEnds{{2.5, 10.5}, {27.5, 10.5}};

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
}  // namespace talus::planner
