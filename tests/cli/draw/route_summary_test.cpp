#include <talus/cli/draw/route_summary.hpp>

#include "example_scene.hpp"

namespace talus::cli {
namespace route_summary_test {

using testing::Contains;
using testing::HasSubstr;
using testing::Pair;
using testing::StartsWith;

TEST(RouteSummary, SummaryListsLengthTimeEnergyAndSlope) {
  const auto facts = summaryOf(exampleRoute());
  EXPECT_THAT(facts, Contains(Pair("length", StartsWith("512.6 m, detour factor 1.00"))));
  EXPECT_THAT(facts, Contains(Pair("driving time", StartsWith("2 h 50 min, mean speed 0.0503 m/s"))));
  EXPECT_THAT(
      facts,
      Contains(Pair("energy", StartsWith("54 kJ (15 Wh), 105.3 J/m; cost including time and risk 60 kJ"))));
  EXPECT_THAT(
      facts,
      Contains(Pair("slope", StartsWith("max uphill 11.5 deg, downhill 11.5 deg, cross-slope 2.9 deg"))));
  EXPECT_THAT(facts, Contains(Pair("traversability", "safe 66.7 %, marginal 33.3 %")));
  EXPECT_THAT(facts, Contains(Pair("drawbar-pull margin", HasSubstr("min +0.100 (DP/W)"))));
  // Closed form: the last vertex of the example has the risk 60 x 0.0002 (a probability, not percent).
  EXPECT_THAT(facts, Contains(Pair("risk", "immobilisation probability 0.012")));
  EXPECT_LE(facts.size(), 11U);
}

TEST(RouteSummary, UnknownValuesAreOmitted) {
  planner::Route route = exampleRoute();
  for (auto& v : route.vertices) v.slip = v.sinkage_m = planner::kNotKnown;
  for (const auto& [what, value] : summaryOf(route)) {
    EXPECT_NE(what, "slip");
    EXPECT_THAT(value, testing::Not(HasSubstr("nan")));
  }
}

TEST(RouteSummary, ZeroLengthRouteIsReportedAsEmpty) {
  planner::Route route = exampleRoute();
  route.vertices.resize(1);
  route.length_m = route.time_s = 0.0;
  EXPECT_EQ(summaryText(route),
            "route                empty: the start is at the goal, or within its tolerance\n");
}

TEST(RouteSummary, FailedRouteIsSummarisedByItsReason) {
  planner::Route route;
  route.status = planner::RouteStatus::NoRoute;
  route.reason = "a cliff";
  EXPECT_EQ(summaryText(route), "route                no_route: a cliff\n");
}

// Closed form: 1 m safe and 3 m marginal.
TEST(RouteSummary, SharesOfCategoriesAreThoseOfTheLength) {
  planner::Route route;
  route.vertices = {{.category = terramech::Category::Safe},
                    {.x_m = 1.0, .category = terramech::Category::Marginal},
                    {.x_m = 4.0}};
  EXPECT_THAT(categoryShares(route), testing::ElementsAre(0.25, 0.75, 0.0, 0.0));
}

TEST(RouteSummary, DurationsHaveTwoUnitsAtMost) {
  EXPECT_EQ(durationText(45.0), "45 s");
  EXPECT_EQ(durationText(1800.0), "30 min");
  EXPECT_EQ(durationText(7500.0), "2 h 05 min");
  EXPECT_EQ(durationText(3.0 * 86400.0 + 4.0 * 3600.0), "3 d 04 h");
}

}  // namespace route_summary_test
}  // namespace talus::cli
