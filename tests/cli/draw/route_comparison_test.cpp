#include <cmath>

#include <talus/cli/draw/route_comparison.hpp>

#include "example_scene.hpp"

namespace talus::cli {
namespace route_comparison_test {

using testing::HasSubstr;

planner::Route through(const std::vector<maps::Point>& points) {
  planner::Route route;
  route.status = planner::RouteStatus::Found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    planner::RouteVertex v;
    v.x_m = points[i].x_m;
    v.y_m = points[i].y_m;
    route.vertices.push_back(v);
    if (i > 0) route.summary.length_m += std::hypot(v.x_m - points[i - 1].x_m, v.y_m - points[i - 1].y_m);
  }
  return route;
}

// Closed form: a straight line and a line with a triangular detour of height 30; the distance at which the
// sides of the triangle exceed the tolerance of 2 is known.
TEST(RouteComparison, DivergingPartMatchesClosedForm) {
  const planner::Route straight = through({{0, 0}, {100, 0}});
  const planner::Route detour = through({{0, 0}, {30, 0}, {50, 30}, {70, 0}, {100, 0}});
  const auto found = partings(detour, straight, 2.0);
  ASSERT_EQ(found.size(), 1U);
  const double side = std::hypot(20.0, 30.0), leaves = 30.0 + 2.0 * side / 30.0;
  EXPECT_NEAR(found[0].from_m, leaves, 1.0);  // the route is sampled every metre
  EXPECT_NEAR(found[0].to_m, 30.0 + 2.0 * side - 2.0 * side / 30.0, 1.0);
  EXPECT_NEAR(found[0].most_m, 30.0, 1.0);
  EXPECT_NEAR(found[0].begin.x_m, 30.0 + 20.0 * 2.0 / 30.0, 1.0);
  EXPECT_NEAR(found[0].end.x_m, 70.0 - 20.0 * 2.0 / 30.0, 1.0);
}

// Property: no deviation for equal routes with other vertices or an empty route, two for a route that leaves
// twice.
TEST(RouteComparison, PartingsAreCounted) {
  const planner::Route straight = through({{0, 0}, {100, 0}});
  EXPECT_TRUE(partings(straight, through({{0, 0}, {13, 0}, {77, 0}, {100, 0}}), 0.5).empty());
  EXPECT_EQ(partings(through({{0, 0}, {20, 0}, {30, 9}, {40, 0}, {60, 0}, {70, -9}, {80, 0}}), straight, 1.0)
                .size(),
            2U);
  EXPECT_TRUE(partings(planner::Route(), straight, 1.0).empty());
}

TEST(RouteComparison, DifferingAndEqualFactsAreSeparated) {
  Scene scene = sceneOf(exampleMap(), {.title = "two"});
  NamedRoute first{"a", exampleRoute(), {{"soil", "sand"}, {"seed", "1"}}};
  NamedRoute second{"b", exampleRoute(), {{"soil", "clay"}, {"seed", "1"}}};
  second.route.summary.energy_J = 60000.0;
  compare(scene, {first, second});
  std::vector<std::string> differing;
  for (const ComparedFact& fact : scene.comparison) {
    differing.push_back(fact.name);
    EXPECT_EQ(fact.values.size(), 2U);
  }
  EXPECT_THAT(differing, testing::ElementsAre("energy", "soil", "parts (> 10 m)"));
  EXPECT_EQ(scene.comparison.back().values[1], "nowhere");
  EXPECT_THAT(scene.facts, testing::Contains(Fact("seed", "1")));
  EXPECT_EQ(scene.routes.size(), 2U);
}

}  // namespace route_comparison_test
}  // namespace talus::cli
