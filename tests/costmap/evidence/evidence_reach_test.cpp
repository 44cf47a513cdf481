#include <string>
#include <vector>

#include <site_map.hpp>

#include <talus/costmap/evidence/evidence_reach.hpp>
#include <talus/costmap/map/traversability_map.hpp>

namespace talus::costmap {
namespace evidence_reach_test {

TEST(EvidenceReach, ReachIsAlignedToPatchesWithinTheMap) {
  const TraversabilityMap map = mapOf(std::vector<std::string>(60, std::string(60, '1')));
  EvidenceReach reach(map.surface().site());
  EXPECT_TRUE(reach.boxes().empty());
  const maps::CellBox near = reach.add({.column = 0, .row = 0}, 0.0);
  EXPECT_EQ(near.first, (maps::Cell{0, 0}));
  EXPECT_EQ(reach.farthest_m(), 0.0);
  // Property: the boxes lie within the map, do not overlap, and cover the box returned by add().
  int cells = 0;
  for (const maps::CellBox& box : reach.boxes()) cells += box.width() * box.height();
  EXPECT_EQ(cells, near.width() * near.height());
  // Property: a larger pose error never reduces the reach.
  const maps::CellBox far = reach.add({.column = 0, .row = 0}, 20.0);
  EXPECT_GT(far.last.column, near.last.column);
  EXPECT_LT(far.last.column, 60);
  EXPECT_EQ(reach.farthest_m(), 20.0);
}

}  // namespace evidence_reach_test
}  // namespace talus::costmap
