#include <cmath>
#include <numbers>
#include <random>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/planner/check/annotation.hpp>
#include <talus/planner/route/polyline.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace annotation_test {

// Level and sloping ground with tables of travel states.
std::shared_ptr<const costmap::CostGrid> mapWithStates() {
  std::vector<costmap::TravelState> all(costmap::TravelCurve::kBins);
  for (int bin = 0; bin < 512; ++bin) {
    auto& state = all[static_cast<std::size_t>(bin)];
    const float g = static_cast<float>(bin - 256) / 256.0F;
    state.slip = g;
    state.energy_J_per_m = 10.0F + 100.0F * std::max(g, 0.0F);
    state.time_s_per_m = 2.0F;
    state.risk_per_m = 0.01F;
    state.category = terramech::Category::Safe;
  }
  const auto states = std::make_shared<costmap::TabulatedStates>(std::move(all));
  const auto cost = std::make_shared<costmap::TravelCost>(
      costmap::TravelCost::Limits{}, std::vector<costmap::GroundCost>{{testing::curve({}), states}});
  maps::Raster<costmap::CellCode> cells({.width = 4, .height = 2, .resolution_m = 1.0, .south_west = {}},
                                        costmap::CellCode({.dz_dx = 0.0, .dz_dy = 0.0, .curve = 0}));
  cells[{2, 0}] = costmap::CellCode({.dz_dx = 0.25, .dz_dy = 0.125, .curve = 0});
  return std::make_shared<costmap::CostGrid>(costmap::flattened(cells, cost));
}

TEST(Annotation, VerticesLieOnCellBorders) {
  const auto map = mapWithStates();
  Plan plan{RouteStatus::Found, {}, {{0.5, 0.5}, {3.5, 0.5}}, 40.0, 20.0};
  const Route route = annotated(plan, {.map = *map, .planner = "field"});
  ASSERT_EQ(route.vertices.size(), 5U);  // start, three borders of cells, end
  const RouteVertex& slope = route.vertices[2];
  EXPECT_EQ(slope.x_m, 2.0);
  EXPECT_NEAR(slope.slope_along_rad, std::atan(0.25), 1e-12);
  EXPECT_NEAR(slope.slope_across_rad, std::atan(0.125), 1e-12);
  EXPECT_NEAR(slope.slip, 0.25, 1e-6);
  EXPECT_EQ(slope.category, terramech::Category::Safe);
  EXPECT_NEAR(slope.energy_J, 15.0, 1e-6);
  // Closed form: 3 m at 10 J/m and 25 J of climbing; 2 s/m; 1 - exp(-0.03).
  EXPECT_NEAR(route.energy_J, 55.0, 1e-5);
  EXPECT_NEAR(route.vertices.back().energy_J, 55.0, 1e-5);
  EXPECT_NEAR(route.time_s, 6.0, 1e-6);
  EXPECT_NEAR(route.vertices.back().immobilisation_risk, 1 - std::exp(-0.03), 1e-6);
  EXPECT_EQ(route.length_m, 3.0);
  EXPECT_NEAR(route.max_slip, 0.25, 1e-6);
  EXPECT_NEAR(route.gap, 1.0, 1e-12);
}

// Property: annotating the vertices of a route again yields the same route, although vertices lie on sides
// of cells to rounding only.
TEST(Annotation, ReannotatedRouteIsUnchanged) {
  std::mt19937 random(3);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const auto map = testing::randomMap({.width = 20, .height = 20, .seed = seed, .roughness = 0.2});
    Plan plan{RouteStatus::Found, {}, {{1.0 + unit(), 1.0 + unit()}}, 1.0, 1.0};
    for (int k = 0; k < 8; ++k)
      plan.points.push_back({plan.points.back().x_m + 2.0 * unit(), plan.points.back().y_m + 2.0 * unit()});
    const Route route = annotated(plan, {.map = *map});
    plan.points.clear();
    for (const RouteVertex& v : route.vertices) plan.points.push_back({v.x_m, v.y_m});
    const Route again = annotated(plan, {.map = *map});
    ASSERT_EQ(again.vertices.size(), route.vertices.size()) << seed;
    for (std::size_t i = 0; i < route.vertices.size(); ++i)
      EXPECT_NEAR(again.vertices[i].slope_along_rad, route.vertices[i].slope_along_rad, 1e-9)
          << seed << ' ' << i;
  }
}

TEST(Annotation, RouteWithAViolationIsWithheld) {
  const auto map = testing::drawn({".#."});
  const AnnotationInput input{.map = *map, .planner = "field"};
  Plan plan{RouteStatus::Found, {}, {{0.5, 0.5}, {0.9, 0.5}}, 4.0, 4.0};
  EXPECT_EQ(checkedRoute(plan, input).status, RouteStatus::Found);
  plan.drive = {.start = {{0.5, 0.5}, 0.0},
                .legs = {{{1.0, 0.0}, 0.0}}};  // the drive continues into the wall
  EXPECT_EQ(checkedRoute(plan, input).status, RouteStatus::NoneFound);
  plan.drive = {};
  plan.points.push_back({2.5, 0.5});
  const Route route = checkedRoute(plan, input);
  EXPECT_EQ(route.status, RouteStatus::NoneFound);
  EXPECT_TRUE(route.vertices.empty());
  EXPECT_EQ(route.reason,
            "no route: the check refuses the one that 'field' found at 1.50,0.50: blocked for any heading; "
            "please report it");
  ASSERT_TRUE(route.refused);
  EXPECT_EQ(route.refused->vertices.back().x_m, 2.5);
  plan.status = RouteStatus::TimedOut;
  EXPECT_EQ(checkedRoute(plan, input).status, RouteStatus::TimedOut) << "no route to check";
}

TEST(Annotation, ReversedRouteHasNegatedSlopes) {
  const auto map = mapWithStates();
  const Plan back{RouteStatus::Found, {}, {{3.5, 0.5}, {0.5, 0.5}}, 40.0, 20.0};
  const Route route = annotated(back, {.map = *map});
  EXPECT_NEAR(route.vertices[1].slope_along_rad, -std::atan(0.25), 1e-12);
  EXPECT_NEAR(route.vertices[1].heading_rad, std::numbers::pi, 1e-12);
  EXPECT_NEAR(route.energy_J, 30.0, 1e-5);
}

TEST(Annotation, ZeroLengthRouteHasOneVertex) {
  const auto map = mapWithStates();
  const Route route = annotated({RouteStatus::Found, {}, {{0.5, 0.5}}, 0.0, 0.0}, {.map = *map});
  EXPECT_EQ(route.vertices.size(), 1U);
  EXPECT_EQ(route.gap, 0.0);
}

}  // namespace annotation_test
}  // namespace talus::planner
