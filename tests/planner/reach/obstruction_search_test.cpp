#include <stop_token>

#include <talus/common/progress_monitor.hpp>
#include <talus/planner/reach/obstruction_search.hpp>

#include "contour_plane.hpp"
#include "drawn_map.hpp"

namespace talus::planner {
namespace obstruction_search_test {

using testing::drawn;

Obstruction between(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places) {
  HeadingSets headings(map->cost());
  const Reach reach(*map, headings, Reach::Sense::From, places.from);
  return obstructionBetween(*map, headings, reach, places, 0.0);
}

TEST(ObstructionSearch, ReportsBothCellSetsAndTheConstraintBetween) {
  const auto map = drawn({"..#..", "..#..", "..#.."});
  const Segment places{{0.5, 0.5}, {3.5, 1.5}};
  const Obstruction found = between(map, places);
  EXPECT_EQ(found.cells_from_start, 6U);
  EXPECT_EQ(found.cells_to_goal, 6U);
  EXPECT_NEAR(found.first.x_m - found.last.x_m, 2.0, 1e-9);
  ASSERT_TRUE(found.lifting);
  EXPECT_EQ(*found.lifting, Constraint::Hazard);
  EXPECT_THAT(text(found, places),
              ::testing::AllOf(::testing::HasSubstr("6 cells are reachable from the start, 6 lead"),
                               ::testing::HasSubstr("keep-out")));
}

// Property: a stop ends the flood fill between the sets and the search for a constraint; the result contains
// the places only.
TEST(ObstructionSearch, StopEndsTheSearch) {
  const auto map = drawn({"..#..", "..#..", "..#.."});
  const Segment places{{0.5, 0.5}, {3.5, 1.5}};
  HeadingSets headings(map->cost());
  const Reach reach(*map, headings, Reach::Sense::From, places.from);
  std::stop_source source;
  source.request_stop();
  const Obstruction found = obstructionBetween(*map, headings, reach, places, 0.0, {},
                                               ProgressMonitor{.progress = {}, .stop = source.get_token()});
  EXPECT_FALSE(found.tried);
  EXPECT_FALSE(found.lifting);
  EXPECT_EQ(found.last, places.from);
  EXPECT_EQ(found.first, places.to);
}

}  // namespace obstruction_search_test
}  // namespace talus::planner
