#include <string>
#include <vector>

#include <site_map.hpp>

#include <talus/costmap/costmap.hpp>
#include <talus/costmap/evidence/evidence_store.hpp>

namespace talus::costmap {
namespace evidence_store_test {

std::shared_ptr<const GroundSite> siteOf(const std::vector<std::string>& rows, double correlation_length_m) {
  MapLayers layers = drawn(rows);
  const SurfaceKeys keys(layers.elevation.grid(), 1000.0);
  return std::make_shared<GroundSite>(
      GroundSite{.elevation = std::move(layers.elevation),
                 .classes = std::move(layers.classes),
                 .keys = keys,
                 .model = testGround({.correlation_length_m = correlation_length_m})});
}

// Property: every cell lies in the block of its column and row, blocks are adjacent, and the side of a block
// is the largest power of two of cells within a quarter of the correlation length.
TEST(BlockGrid, BlocksPartitionTheMap) {
  for (const double length_m : {2.0, 8.0, 20.0, 40.0}) {
    const auto site = siteOf(std::vector<std::string>(21, std::string(37, '1')), length_m);
    const BlockGrid blocks(site);
    EXPECT_LE(blocks.side_m(), std::max(length_m / 4.0, 1.0));
    EXPECT_GT(2.0 * blocks.side_m(), length_m / 4.0);
    EXPECT_GE(blocks.reach() * blocks.side_m(), length_m);
    for (int row = 0; row < 21; ++row)
      for (int column = 0; column < 37; ++column) {
        const maps::Cell block = blocks.blockOf({column, row});
        EXPECT_TRUE(column >= block.column && column < block.column + blocks.side());
        EXPECT_TRUE(row >= block.row && row < block.row + blocks.side());
        const maps::Cell again = blocks.blockAt(blocks.columnOf({column, row}), blocks.rowOf({column, row}));
        EXPECT_TRUE(again.column == block.column && again.row == block.row);
      }
    EXPECT_EQ(blocks.columns(), blocks.columnOf({36, 0}) + 1);
    EXPECT_EQ(blocks.rows(), blocks.rowOf({0, 20}) + 1);
  }
}

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

}  // namespace evidence_store_test
}  // namespace talus::costmap
