#include <cmath>

#include <gtest/gtest.h>

#include <talus/planner/reach/cell_crossing.hpp>

namespace talus::planner {
namespace cell_crossing_test {

// Whether every leg of a path has a heading of the set and every turn lies within the cell.
bool keeps(const HeadingSet& headings, const std::vector<InCell>& way) {
  for (std::size_t k = 1; k < way.size(); ++k) {
    const InCell leg = way[k] - way[k - 1];
    const double heading = std::atan2(leg.y, leg.x);
    if (std::abs(std::remainder(headings.nearest(heading, 0.0) - heading, HeadingSet::kTurn)) > 1e-6)
      return false;
    if (way[k].x < 0.0 || way[k].x > 1.0 || way[k].y < 0.0 || way[k].y > 1.0) return false;
  }
  return way.size() > 1;
}

TEST(CellDrive, PathIsStraightIfTheHeadingIsAllowed) {
  const HeadingSet east({{6.1, 0.4}});
  const auto way = drivenThrough(east, {{0.0, 0.5}, 0.0}, {{1.0, 0.5}, 0.0});
  ASSERT_EQ(way.size(), 2U);
  EXPECT_TRUE(keeps(east, way));
  EXPECT_DOUBLE_EQ(way[0].y, 0.5);
}

// Property: with two opposite narrow arcs of headings a path tacks across the cell; with one arc it only
// runs along the arc.
TEST(CellDrive, PathTacksBetweenTwoHeadingArcs) {
  const HeadingSet both({{6.2, 0.15}, {3.1, 0.15}});
  const auto way = drivenThrough(both, {{0.3, 0.2}, std::nullopt}, {{0.6, 0.8}, std::nullopt});
  EXPECT_GT(way.size(), 10U);
  EXPECT_TRUE(keeps(both, way));
  EXPECT_TRUE(drivenThrough(HeadingSet({{6.2, 0.15}}), {{0.3, 0.2}, std::nullopt}, {{0.6, 0.8}, std::nullopt})
                  .empty());
}

}  // namespace cell_crossing_test
}  // namespace talus::planner
