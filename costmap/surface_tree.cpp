#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include <costmap/surface_tree.hpp>

namespace talus::costmap {
namespace {

constexpr unsigned kDepth = 16;

struct Cube {
  unsigned x = 0, y = 0, z = 0;
  unsigned level = kDepth;  // side is 2^level cells
};

Cube childOf(const Cube& cube, unsigned child) noexcept {
  const unsigned half = 1U << (cube.level - 1);
  return {cube.x + (child & 1U ? half : 0), cube.y + (child & 2U ? half : 0),
          cube.z + (child & 4U ? half : 0), cube.level - 1};
}

// Fills a tree cube by cube, depth first; prunes each cube as soon as it is done.
template <typename Tree, typename Node, typename SetLeaf>
class Filler {
 public:
  Filler(Tree& tree, const Surface& surface, SetLeaf set_leaf)
      : tree_(tree), pyramid_(surface.elevation_m, surface.keys), set_leaf_(set_leaf) {
    const octomap::OcTreeKey first = surface.keys.key({0, 0}, surface.keys.baseElevation_m());
    first_x_ = first[0];
    first_y_ = first[1];
  }

  bool anything() const { return !pyramid_.range(kDepth, 0, 0).empty(); }

  void fill(Node* node, const Cube& cube) {
    if (cube.level == 0) {
      set_leaf_(*node, maps::Cell{static_cast<int>(cube.x - first_x_), static_cast<int>(cube.y - first_y_)});
      return;
    }
    for (unsigned i = 0; i < 8; ++i) {
      const Cube child = childOf(cube, i);
      if (occupied(child)) fill(childNode(node, i), child);
    }
    // ColorOcTree prunes by occupancy alone and would mix colours.
    if constexpr (std::is_same_v<Tree, TraversabilityTree>) tree_.pruneNode(node);
  }

 private:
  Node* childNode(Node* node, unsigned i) {
    return tree_.nodeChildExists(node, i) ? tree_.getNodeChild(node, i) : tree_.createNodeChild(node, i);
  }

  // Whether a cell of the surface lies in the cube; the pyramid may only say maybe where the surface jumps
  // across it.
  bool occupied(const Cube& cube) const {
    const auto range = pyramid_.range(cube.level, cube.x, cube.y);
    const unsigned side = 1U << cube.level;
    if (range.empty() || !range.meets(cube.z, side)) return false;
    if (range.low >= cube.z || range.high < cube.z + side) return true;
    for (unsigned i = 0; i < 8; ++i)
      if (occupied(childOf(cube, i))) return true;
    return false;
  }

  Tree& tree_;
  SurfacePyramid pyramid_;
  SetLeaf set_leaf_;
  unsigned first_x_ = 0, first_y_ = 0;
};

octomap::ColorOcTreeNode::Color colorOf(const CellBelief& belief) {
  if (has(belief.hazards, Hazard::Unknown)) return {128, 128, 128};
  if (belief.hazards != Hazard::None) return {200, 40, 40};
  constexpr std::array<std::array<std::uint8_t, 3>, 4> kColors{
      {{60, 170, 70}, {240, 170, 30}, {200, 40, 40}, {128, 128, 128}}};
  const auto& c = kColors[belief.category];
  return {c[0], c[1], c[2]};
}

}  // namespace

TraversabilityTree surfaceTree(const Surface& surface, const std::function<CellBelief(maps::Cell)>& belief) {
  TraversabilityTree tree(surface.keys.grid().resolution_m);
  const auto set = [&](TraversabilityNode& node, maps::Cell cell) { node.belief() = belief(cell); };
  Filler<TraversabilityTree, TraversabilityNode, decltype(set)> filler(tree, surface, set);
  if (filler.anything()) filler.fill(tree.makeRoot(), Cube{});
  return tree;
}

std::unique_ptr<octomap::ColorOcTree> colorTree(const Surface& surface,
                                                const std::function<CellBelief(maps::Cell)>& belief) {
  auto owned = std::make_unique<octomap::ColorOcTree>(surface.keys.grid().resolution_m);
  octomap::ColorOcTree& tree = *owned;
  const auto set = [&](octomap::ColorOcTreeNode& node, maps::Cell cell) {
    node.setLogOdds(tree.getClampingThresMaxLog());
    node.setColor(colorOf(belief(cell)));
  };
  Filler<octomap::ColorOcTree, octomap::ColorOcTreeNode, decltype(set)> filler(tree, surface, set);
  if (!filler.anything()) return owned;
  // OctoMap makes a root only for a voxel: any voxel of the surface will do.
  const auto& heights = surface.elevation_m.values();
  const auto first =
      std::find_if(heights.begin(), heights.end(), [](float height) { return !std::isnan(height); });
  const auto index = static_cast<int>(first - heights.begin());
  const maps::Cell cell{index % surface.keys.grid().width, index / surface.keys.grid().width};
  tree.setNodeValue(surface.keys.key(cell, static_cast<double>(*first)), tree.getClampingThresMaxLog());
  filler.fill(tree.getRoot(), Cube{});
  tree.updateInnerOccupancy();
  return owned;
}

}  // namespace talus::costmap
