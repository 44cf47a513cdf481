#include <memory>
#include <sstream>

#include <talus/common/common.hpp>
#include <talus/costmap/surface/surface.hpp>

namespace talus::costmap {
namespace traversability_tree_test {

using octomap::OcTreeKey;

CellBelief sandy() {
  return {.pull_mean = 0.25F,
          .pull_std = 0.05F,
          .sinkage_mean = 0.2F,
          .terrain_class = 2,
          .category = 0,
          .confidence = 16};
}

TraversabilityTree sample() {
  TraversabilityTree tree(0.5);
  for (unsigned short x = 0; x < 8; ++x)
    for (unsigned short y = 0; y < 8; ++y) tree.at(OcTreeKey(32768 + x, 32768 + y, 32770)) = sandy();
  tree.at(OcTreeKey(32770, 32770, 32770)).evidence = 3.5F;
  tree.prune();
  return tree;
}

std::string bytesOf(const TraversabilityTree& tree) {
  std::ostringstream stream;
  writeTree(tree, stream);
  return stream.str();
}

TraversabilityTree fromBytes(const std::string& bytes) {
  std::istringstream stream(bytes);
  return readTree(stream, "map.ot");
}

TEST(TraversabilityTree, EqualCellsArePrunedAndDifferingCellsKept) {
  const TraversabilityTree tree = sample();
  // Property: 64 cells that are equal except one need far fewer leaves, and each cell can still be read.
  EXPECT_LT(tree.getNumLeafNodes(), 12U);
  EXPECT_EQ(tree.find(OcTreeKey(32770, 32770, 32770))->evidence, 3.5F);
  EXPECT_EQ(*tree.find(OcTreeKey(32775, 32769, 32770)), sandy());
  EXPECT_EQ(tree.find(OcTreeKey(100, 100, 100)), nullptr);
}

TEST(TraversabilityTree, SplittingAPrunedCubeKeepsTheOtherCells) {
  TraversabilityTree tree = sample();
  tree.at(OcTreeKey(32775, 32775, 32770)).pull_mean = -0.1F;
  EXPECT_EQ(*tree.find(OcTreeKey(32774, 32775, 32770)), sandy());
  EXPECT_EQ(tree.find(OcTreeKey(32775, 32775, 32770))->pull_mean, -0.1F);
}

TEST(TraversabilityTree, SerialisationIsDeterministicAndRoundTrips) {
  const std::string bytes = bytesOf(sample());
  EXPECT_EQ(bytes, bytesOf(sample()));
  EXPECT_EQ(bytes, bytesOf(fromBytes(bytes)));
  const TraversabilityTree copy = fromBytes(bytes);
  EXPECT_EQ(bytes, bytesOf(TraversabilityTree(copy)));
}

TEST(TraversabilityTree, TypeIsRegisteredWithOctoMap) {
  std::istringstream stream(bytesOf(sample()));
  const std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(stream));
  const auto* ours = dynamic_cast<TraversabilityTree*>(tree.get());
  ASSERT_NE(ours, nullptr);
  EXPECT_EQ(bytesOf(*ours), bytesOf(sample()));
}

TEST(TraversabilityTree, EveryTruncationIsRejected) {
  const std::string bytes = bytesOf(sample());
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(fromBytes(bytes.substr(0, length)), InputError) << length;
}

TEST(TraversabilityTree, DamagedBytesAreReadOrRejected) {
  const std::string bytes = bytesOf(sample());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ 0xff);
    try {
      fromBytes(damaged);
    } catch (const InputError&) {
    }
  }
}

TEST(TraversabilityTree, UnsupportedTreeTypeIsNamedInTheError) {
  try {
    fromBytes("# Octomap OcTree file\nid ColorOcTree\nsize 1\nres 0.1\ndata\n");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "map.ot: OctoMap tree of type 'ColorOcTree', not TraversabilityTree; a point-cloud OctoMap "
                 "is read as a DEM");
  }
}

}  // namespace traversability_tree_test
}  // namespace talus::costmap
