#include <cmath>
#include <functional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <refused.hpp>
#include <site_map.hpp>

#include <talus/common/common.hpp>
#include <talus/costmap/costmap.hpp>
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

// A slope of voxels with a slab above a section of the slope and free space between.
template <typename Tree>
void fill(Tree& tree) {
  const auto voxel = [](int column, int row, double z) {
    return octomap::point3d(static_cast<float>(0.1 * column + 0.05), static_cast<float>(0.1 * row + 0.05),
                            static_cast<float>(z));
  };
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 10; ++y) {
      tree.updateNode(voxel(x, y, 0.1 * (x / 4) + 0.05), true);
      tree.updateNode(voxel(x, y, 2.05), false);
      if (x < 5) tree.updateNode(voxel(x, y, 1.05), true);
    }
  tree.updateInnerOccupancy();
}

void expectSlopeUnderSlab(const maps::ElevationMap& map) {
  ASSERT_EQ(map.grid().width, 20);
  ASSERT_EQ(map.grid().height, 10);
  // Closed form: the slope of fill(); heights are voxel centres, stored as floats.
  EXPECT_NEAR(map.elevation_m[(maps::Cell{2, 3})], 1.05, 1e-6);
  EXPECT_NEAR(map.elevation_m[(maps::Cell{12, 3})], 0.35, 1e-6);
  EXPECT_NEAR(map.grid().centre({12, 3}).x_m, 1.25, 1e-9);
}

TEST(OctomapSurface, ReadsFullBinaryAndColourTrees) {
  octomap::OcTree tree(0.1);
  fill(tree);
  std::stringstream full, binary, coloured;
  tree.write(full);
  tree.writeBinaryConst(binary);
  octomap::ColorOcTree colour(0.1);
  fill(colour);
  colour.write(coloured);
  expectSlopeUnderSlab(octomapGround(full, "a.ot"));
  expectSlopeUnderSlab(octomapGround(binary, "a.bt"));
  expectSlopeUnderSlab(octomapGround(coloured, "c.ot"));
}

// Closed form: one voxel in each octant; the cell of its column is where the voxel is.
TEST(OctomapSurface, EveryOctantKeepsItsCoordinates) {
  for (int octant = 0; octant < 8; ++octant) {
    const auto sign = [&](int axis) { return octant >> axis & 1 ? 1.0 : -1.0; };
    const octomap::point3d at(static_cast<float>(3.05 * sign(0)), static_cast<float>(7.25 * sign(1)),
                              static_cast<float>(1.15 * sign(2)));
    octomap::OcTree tree(0.1);
    tree.updateNode(at, true);
    std::stringstream stream;
    tree.writeBinaryConst(stream);
    const maps::ElevationMap map = octomapGround(stream, "octant.bt");
    ASSERT_EQ(map.grid().size(), 1U);
    EXPECT_NEAR(map.grid().centre({0, 0}).x_m, 3.05 * sign(0), 1e-6) << octant;
    EXPECT_NEAR(map.grid().centre({0, 0}).y_m, 7.25 * sign(1), 1e-6) << octant;
    EXPECT_NEAR((map.elevation_m[{0, 0}]), 1.15 * sign(2), 1e-6) << octant;
  }
}

TEST(OctomapSurface, CeilingSelectsTheGroundBelow) {
  octomap::OcTree tree(0.1);
  fill(tree);
  std::stringstream stream;
  tree.writeBinaryConst(stream);
  const maps::ElevationMap ground = octomapGround(stream, "a.bt", 0.8);
  EXPECT_NEAR(ground.elevation_m[(maps::Cell{2, 3})], 0.05, 1e-6);
  EXPECT_NEAR(ground.elevation_m[(maps::Cell{12, 3})], 0.35, 1e-6);
  stream.seekg(0);
  EXPECT_THROW(octomapGround(stream, "a.bt", -1.0), InputError);
}

// Property: a rock of two voxels above the ground leaves no headroom, and a gap in a scan is no headroom.
TEST(OctomapSurface, GroundRequiresFreeHeadroom) {
  for (const double slab_m : {0.35, 0.55, 0.65}) {
    octomap::OcTree tree(0.1);
    tree.updateNode(octomap::point3d(0.05F, 0.05F, 0.05F), true);
    tree.updateNode(octomap::point3d(0.05F, 0.05F, static_cast<float>(slab_m)), true);
    std::stringstream stream;
    tree.write(stream);
    // Closed form: 2, 4 and 5 voxels between ground and slab are free; headroom of half a metre needs 5.
    if (slab_m > 0.6)
      EXPECT_NEAR((octomapGround(stream, "a.ot", 0.2).elevation_m[{0, 0}]), 0.05, 1e-6);
    else
      EXPECT_REFUSED(octomapGround(stream, "a.ot", 0.2), InputError, "no ground at or below");
  }
}

TEST(OctomapSurface, EveryTruncationIsRejected) {
  octomap::OcTree tree(0.1);
  fill(tree);
  for (const bool binary : {false, true}) {
    std::ostringstream out;
    if (binary)
      tree.writeBinaryConst(out);
    else
      tree.write(out);
    const std::string bytes = out.str();
    for (std::size_t length = 0; length < bytes.size(); length += 3) {
      std::istringstream in(bytes.substr(0, length));
      EXPECT_THROW(octomapGround(in, "cut.ot"), InputError) << length;
    }
  }
}

// An OcTree whose only leaf is `depth` levels below the root, with the given voxel size.
std::string oneCube(int depth, const std::string& resolution) {
  std::string bytes = "# Octomap OcTree file\nid OcTree\nsize 2\nres " + resolution + "\ndata\n";
  for (int k = 0; k < depth; ++k) bytes += std::string("\0\0\0\0\x01", 5);
  return bytes + std::string("\0\0\x80\x3f\0", 5);
}

// Closed form: the cube begins at the lowest key and has the side 2^(16 - depth); its top voxel is at side -
// 0.5 - 2^15.
TEST(OctomapSurface, LargeLeafIsASurfaceOfItsFullWidth) {
  std::istringstream stream(oneCube(6, "0.1"));
  const maps::ElevationMap ground = octomapGround(stream, "cube.ot");
  EXPECT_EQ(ground.grid().width, 1024);
  for (const maps::Cell cell : {maps::Cell{0, 0}, maps::Cell{511, 3}, maps::Cell{1023, 1023}})
    EXPECT_FLOAT_EQ(ground.elevation_m[cell], static_cast<float>((1023.5 - 32768.0) * 0.1));
}

// Property: a small file that declares a huge extent is rejected before memory or time is spent.
TEST(OctomapSurface, OversizedLeavesAreRejected) {
  for (const int depth : {0, 1}) {
    std::istringstream stream(oneCube(depth, "0.1"));
    EXPECT_REFUSED(octomapGround(stream, "cube.ot"), InputError, "columns, more than 4e8") << depth;
  }
}

TEST(OctomapSurface, VoxelSizesOutOfRangeAreRejected) {
  for (const char* resolution : {"1e-300", "1e-4", "1e7", "1e308"}) {
    std::istringstream stream(oneCube(16, resolution));
    EXPECT_REFUSED(octomapGround(stream, "cube.ot"), InputError, "must be 0.001 m to 1000 km") << resolution;
  }
  for (const char* resolution : {"nan", "inf", "-0.1", ""}) {
    std::istringstream stream(oneCube(16, resolution));
    EXPECT_REFUSED(octomapGround(stream, "cube.ot"), InputError, "not an OctoMap file") << resolution;
  }
}

TEST(OctomapSurface, UnsupportedTreeTypeIsRejected) {
  std::istringstream stream("# Octomap OcTree file\nid OcTreeStamped\nsize 1\nres 0.1\ndata\n");
  EXPECT_THROW(octomapGround(stream, "x.ot"), InputError);
  EXPECT_FALSE(octomapType("/dev/null").has_value());
}

}  // namespace surface_tree_test

}  // namespace talus::costmap
