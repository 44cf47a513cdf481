#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <octomap/ColorOcTree.h>
#include <site_map.hpp>

#include <talus/costmap/map/map_file.hpp>
#include <talus/costmap/surface/surface_tree.hpp>

namespace talus::costmap {
namespace surface_tree_test {

// A step of five cells in height, so that the surface contains gaps of several voxels.
MapLayers cliff() {
  MapLayers layers = drawn({"1111", "11?1", "1111", "1111"});
  for (int row = 0; row < 4; ++row) layers.elevation.elevation_m[{3, row}] += 5.0F;
  return layers;
}

TEST(SurfaceTree, ColourTreeHasOneLeafPerCellAndIsReadByOctoMap) {
  const TraversabilityMap map(cliff(), testGround(), {});
  const auto tree = colorTree({map.elevation().elevation_m, map.surface().keys()},
                              [&](maps::Cell c) { return map.belief(c); });
  EXPECT_EQ(tree->getNumLeafNodes(), 15U);  // Closed form: 16 cells, one without elevation
  std::stringstream stream;
  tree->write(stream);
  const std::unique_ptr<octomap::AbstractOcTree> back(octomap::AbstractOcTree::read(stream));
  const auto* colour = dynamic_cast<octomap::ColorOcTree*>(back.get());
  ASSERT_NE(colour, nullptr);
  const auto* cell = colour->search(map.surface().keys().key({0, 0}, 1000.0));
  ASSERT_NE(cell, nullptr);
  EXPECT_GT(cell->getColor().r, cell->getColor().g) << "at the edge of the map, refused: red";
}

std::string held(const TraversabilityMap& map) {
  std::ostringstream stream;
  writeTree(treeOf(map), stream);
  return stream.str();
}

std::string streamed(const TraversabilityMap& map) {
  std::ostringstream stream;
  writeTree(map, stream);
  return stream.str();
}

// Property: the streamed bytes equal those of a tree in memory, on even and rough ground, with and without
// evidence, for uniform and for empty maps.
TEST(SurfaceTree, StreamedBytesEqualTheTree) {
  EXPECT_EQ(streamed(TraversabilityMap(drawn({"??", "??"}), testGround(), {})),
            held(TraversabilityMap(drawn({"??", "??"}), testGround(), {})));
  EXPECT_EQ(streamed(mapOf({"1"})), held(mapOf({"1"})));
  EXPECT_EQ(streamed(TraversabilityMap(cliff(), testGround(), {})),
            held(TraversabilityMap(cliff(), testGround(), {})));
  std::mt19937 random(3);
  for (const double rise : {0.0, 0.3}) {
    std::vector<std::string> rows(50, std::string(70, '1'));
    for (auto& line : rows)
      for (char& c : line) c = "11111111112?#"[random() % 13];
    TraversabilityMap map = mapOf(rows, rise);
    EXPECT_EQ(streamed(map), held(map));
    for (int i = 0; i < 200; ++i)
      map.learn(
          {.time_s = 1.0,
           .place = {100.0 + static_cast<double>(random() % 70), 200.0 + static_cast<double>(random() % 50)},
           .pull = {0.2, 0.05},
           .sinkage = {0.2, 0.05}});
    map.publish();
    EXPECT_EQ(streamed(map), held(map));
  }
}

TEST(SurfaceTree, WithoutElevationTheTreeIsEmpty) {
  MapLayers layers = drawn({"??", "??"});
  const TraversabilityMap map(std::move(layers), testGround(), {});
  EXPECT_EQ(treeOf(map).size(), 0U);
  EXPECT_EQ(colorTree({map.elevation().elevation_m, map.surface().keys()},
                      [&](maps::Cell c) { return map.belief(c); })
                ->size(),
            0U);
}

}  // namespace surface_tree_test
}  // namespace talus::costmap
