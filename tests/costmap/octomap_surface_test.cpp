#include <cmath>
#include <functional>
#include <sstream>

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <costmap/octomap_surface.hpp>
#include <talus.hpp>

namespace talus::costmap {
namespace {

// A slope of voxels with a slab above part of it and free space between.
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
  // Closed form: the drawing above; voxel middles, float heights.
  EXPECT_NEAR(map.elevation_m[(maps::Cell{2, 3})], 1.05, 1e-6);
  EXPECT_NEAR(map.elevation_m[(maps::Cell{12, 3})], 0.35, 1e-6);
  EXPECT_NEAR(map.grid().centre({12, 3}).x_m, 1.25, 1e-9);
}

TEST(OctomapSurface, ReadsFullAndBinaryAndColour) {
  octomap::OcTree tree(0.1);
  fill(tree);
  std::stringstream full, binary, coloured;
  tree.write(full);
  tree.writeBinaryConst(binary);
  octomap::ColorOcTree colour(0.1);
  fill(colour);
  colour.write(coloured);
  expectSlopeUnderSlab(octomapSurface(full, "a.ot"));
  expectSlopeUnderSlab(octomapSurface(binary, "a.bt"));
  expectSlopeUnderSlab(octomapSurface(coloured, "c.ot"));
}

TEST(OctomapSurface, RefusesEveryTruncationAndSurvivesDamage) {
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
      EXPECT_THROW(octomapSurface(in, "cut.ot"), InputError) << length;
    }
  }
}

TEST(OctomapSurface, NamesAForeignTree) {
  std::istringstream stream("# Octomap OcTree file\nid OcTreeStamped\nsize 1\nres 0.1\ndata\n");
  EXPECT_THROW(octomapSurface(stream, "x.ot"), InputError);
  EXPECT_FALSE(octomapType("/dev/null").has_value());
}

}  // namespace
}  // namespace talus::costmap
