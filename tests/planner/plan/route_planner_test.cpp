#include <cmath>
#include <memory>

#include <talus/planner/plan/route_planner.hpp>

#include "drawn_map.hpp"
#include "rolling_ground.hpp"

namespace talus::planner {
namespace route_planner_test {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const maps::Grid kYard{.width = 60, .height = 50, .resolution_m = kCell_m, .south_west = {100.0, -50.0}};

PlanRequest overTheYard() {
  return {.start = {110.0, -40.0}, .goal = {210.0, 40.0}};
}

// A step across the map with a gap in the north; the step is not in the map's cost.
std::shared_ptr<const Chassis> stepped(const costmap::TraversabilityMap& map) {
  static const maps::Raster<float> steps = [] {
    maps::Raster<float> made(kYard, 0.0F);
    for (int row = 0; row < 45; ++row) made[{30, row}] = 1.0F;
    return made;
  }();
  return std::make_shared<const Chassis>(steps, map.model().rover(), Suspension::Rigid);
}

// Property: a plugin that plans as Talus does gives the same route through the same entry point.
TEST(RoutePlanner, PluginRouteIsCheckedAndAnnotatedLikeOurs) {
  const costmap::TraversabilityMap map = built(kYard);
  RoutePlanner own, plugin(PluginPlanner(TALUS_PLUGIN));
  for (const bool chassis : {false, true}) {
    PlanRequest request = overTheYard();
    if (chassis) request.chassis = stepped(map);
    const Route ours = own.plan(map.published(), request, {}),
                theirs = plugin.plan(map.published(), request, {});
    ASSERT_EQ(ours.status, RouteStatus::Found) << ours.reason;
    ASSERT_EQ(theirs.status, RouteStatus::Found) << theirs.reason;
    EXPECT_NEAR(theirs.summary.cost, ours.summary.cost, 1e-9 * ours.summary.cost);
    EXPECT_EQ(theirs.summary.planner, "field of talus");
    ASSERT_EQ(theirs.vertices.size(), ours.vertices.size());
    EXPECT_EQ(theirs.vertices[1].elevation_m, ours.vertices[1].elevation_m);
  }
}

TEST(RoutePlanner, PluginRejectsARiskLimit) {
  RoutePlanner plugin(PluginPlanner(TALUS_PLUGIN));
  PlanRequest request = overTheYard();
  request.risk_limit = RiskLimit{};
  EXPECT_THAT([&] { plugin.plan(built(kYard).published(), request, {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("risk_limit is not honoured")));
}

TEST(RoutePlanner, ReplanningIsDeterministic) {
  const auto map = randomMap({.width = 60, .height = 50, .seed = 11, .blocked = 0.05});
  RoutePlanner planner;
  const PlanRequest there{.start = map->grid().centre({2, 3}), .goal = map->grid().centre({55, 45})};
  const PlanRequest back{.start = there.goal, .goal = there.start};
  const double first = planner.plan(map, there, {}).summary.cost;
  planner.plan(map, back, {});
  EXPECT_EQ(planner.plan(map, there, {}).summary.cost, first);
}

}  // namespace route_planner_test
}  // namespace talus::planner
