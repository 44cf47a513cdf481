#include <cmath>
#include <sstream>

#include <octomap/ColorOcTree.h>
#include <site_map.hpp>

#include <costmap/surface_tree.hpp>

namespace talus::costmap {
namespace {

// A step of five cells, so that the surface leaves cubes out between.
MapLayers cliff() {
  MapLayers layers = drawn({"1111", "11?1", "1111", "1111"});
  for (int row = 0; row < 4; ++row) layers.elevation.elevation_m[{3, row}] += 5.0F;
  return layers;
}

TEST(SurfaceTree, ColourTreeHasALeafACellAndStockReadsIt) {
  const TraversabilityMap map(cliff(), testGround(), {});
  const auto tree =
      colorTree({map.elevation().elevation_m, map.keys()}, [&](maps::Cell c) { return map.belief(c); });
  EXPECT_EQ(tree->getNumLeafNodes(), 15U);  // Closed form: 16 cells, one without elevation
  std::stringstream stream;
  tree->write(stream);
  const std::unique_ptr<octomap::AbstractOcTree> back(octomap::AbstractOcTree::read(stream));
  const auto* colour = dynamic_cast<octomap::ColorOcTree*>(back.get());
  ASSERT_NE(colour, nullptr);
  const auto* cell = colour->search(map.keys().key({0, 0}, 1000.0));
  ASSERT_NE(cell, nullptr);
  EXPECT_GT(cell->getColor().g, cell->getColor().r) << "safe is green";
}

TEST(SurfaceTree, NoElevationNoTree) {
  MapLayers layers = drawn({"??", "??"});
  const TraversabilityMap map(std::move(layers), testGround(), {});
  EXPECT_EQ(map.tree().size(), 0U);
  EXPECT_EQ(colorTree({map.elevation().elevation_m, map.keys()}, [&](maps::Cell c) { return map.belief(c); })
                ->size(),
            0U);
}

}  // namespace
}  // namespace talus::costmap
