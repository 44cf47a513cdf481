#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>
#include <utility>

#include <talus/costmap/surface/octree_keys.hpp>
#include <talus/costmap/surface/surface_tree.hpp>

namespace talus::costmap {
namespace {

struct Cube {
  unsigned x = 0, y = 0, z = 0;
  unsigned level = kOctreeDepth;  // side is 2^level cells
};

Cube childOf(const Cube& cube, unsigned child) noexcept {
  const unsigned half = 1U << (cube.level - 1);
  return {cube.x + (child & 1U ? half : 0), cube.y + (child & 2U ? half : 0),
          cube.z + (child & 4U ? half : 0), cube.level - 1};
}

// Occupancy of cubes by the surface.
class Cubes {
 public:
  explicit Cubes(const Surface& surface) : pyramid_(surface.elevation_m, surface.keys) {
    const octomap::OcTreeKey first = surface.keys.key({0, 0}, surface.keys.baseElevation_m());
    first_x_ = first[0];
    first_y_ = first[1];
  }

  bool anything() const { return occupied(Cube{}); }
  // True if a cube contains a cell of the surface. If the height range of the block extends below and above
  // the cube, the children of the cube are checked.
  bool occupied(const Cube& cube) const {
    const auto range = pyramid_.range(cube.level, cube.x, cube.y);
    const unsigned side = 1U << cube.level;
    if (range.empty() || !range.meets(cube.z, side)) return false;
    if (range.low >= cube.z || range.high < cube.z + side) return true;
    for (unsigned i = 0; i < 8; ++i)
      if (occupied(childOf(cube, i))) return true;
    return false;
  }

  std::uint8_t childrenOf(const Cube& cube) const {
    unsigned bits = 0;
    for (unsigned i = 0; i < 8; ++i) bits |= (occupied(childOf(cube, i)) ? 1U : 0U) << i;
    return static_cast<std::uint8_t>(bits);
  }

  maps::Cell cellOf(const Cube& voxel) const {
    return {static_cast<int>(voxel.x - first_x_), static_cast<int>(voxel.y - first_y_)};
  }

 private:
  SurfacePyramid pyramid_;
  unsigned first_x_ = 0, first_y_ = 0;
};

// Fills a tree depth first and prunes each cube after its children.
template <typename Tree, typename Node, typename SetLeaf>
class Filler {
 public:
  Filler(Tree& tree, const Cubes& cubes, SetLeaf set_leaf)
      : tree_(tree), cubes_(cubes), set_leaf_(set_leaf) {}

  void fill(Node* node, const Cube& cube) {
    if (cube.level == 0) return set_leaf_(*node, cube);
    const unsigned children = cubes_.childrenOf(cube);
    for (unsigned i = 0; i < 8; ++i)
      if (children >> i & 1U) fill(childNode(node, i), childOf(cube, i));
    // ColorOcTree prunes by occupancy alone, which would merge different colours.
    if constexpr (std::is_same_v<Tree, TraversabilityTree>) tree_.pruneNode(node);
  }

 private:
  Node* childNode(Node* node, unsigned i) {
    return tree_.nodeChildExists(node, i) ? tree_.getNodeChild(node, i) : tree_.createNodeChild(node, i);
  }

  Tree& tree_;
  const Cubes& cubes_;
  SetLeaf set_leaf_;
};

// Writes nodes in the order of the file. A cube is written as soon as two of its leaves differ; until then,
// only the common estimate and the number of leaves are stored.
class TreeStreamWriter {
 public:
  using Leaf = std::function<CellBelief(const Cube&)>;
  TreeStreamWriter(const Cubes& cubes, Leaf leaf, TreeWriter& writer)
      : cubes_(cubes), leaf_(std::move(leaf)), writer_(writer) {}

  void write() {
    if (const auto all_alike = walk(Cube{}, nullptr)) writer_.node(*all_alike, 0);
  }

 private:
  struct Open {
    Open* parent;
    std::uint8_t children;
    bool written = false;
    CellBelief held{};
    unsigned count = 0;
  };

  // Common estimate of a cube with equal leaves; nullopt if the cube was written as an inner node.
  std::optional<CellBelief> walk(const Cube& cube, Open* parent) {
    if (cube.level == 0) return leaf_(cube);
    Open open{.parent = parent, .children = cubes_.childrenOf(cube)};
    for (unsigned i = 0; i < 8; ++i) {
      if (!(open.children >> i & 1U)) continue;
      const auto leaf = walk(childOf(cube, i), &open);
      if (!leaf) continue;
      if (open.count > 0 && !(open.held == *leaf)) differ(open);
      if (open.written)
        writer_.node(*leaf, 0);
      else
        open.held = *leaf, ++open.count;
    }
    if (open.written) return std::nullopt;
    return open.held;
  }

  void differ(Open& open) {
    if (open.written) return;
    if (open.parent) differ(*open.parent);
    writer_.node(CellBelief{}, open.children);
    for (unsigned i = 0; i < open.count; ++i) writer_.node(open.held, 0);
    open.written = true;
  }

  const Cubes& cubes_;
  Leaf leaf_;
  TreeWriter& writer_;
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
  const Cubes cubes(surface);
  const auto set = [&](TraversabilityNode& node, const Cube& voxel) {
    node.belief() = belief(cubes.cellOf(voxel));
  };
  Filler<TraversabilityTree, TraversabilityNode, decltype(set)> filler(tree, cubes, set);
  if (cubes.anything()) filler.fill(tree.makeRoot(), Cube{});
  return tree;
}

void writeSurfaceTree(const Surface& surface, const std::function<CellBelief(maps::Cell)>& belief,
                      std::ostream& stream) {
  TreeWriter writer(stream, surface.keys.grid().resolution_m);
  const Cubes cubes(surface);
  const auto leaf = [&](const Cube& voxel) { return belief(cubes.cellOf(voxel)); };
  if (cubes.anything()) TreeStreamWriter(cubes, leaf, writer).write();
  writer.finish();
}

std::unique_ptr<octomap::ColorOcTree> colorTree(const Surface& surface,
                                                const std::function<CellBelief(maps::Cell)>& belief) {
  auto owned = std::make_unique<octomap::ColorOcTree>(surface.keys.grid().resolution_m);
  octomap::ColorOcTree& tree = *owned;
  const Cubes cubes({surface.elevation_m, surface.keys});
  const auto set = [&](octomap::ColorOcTreeNode& node, const Cube& voxel) {
    node.setLogOdds(tree.getClampingThresMaxLog());
    node.setColor(colorOf(belief(cubes.cellOf(voxel))));
  };
  if (!cubes.anything()) return owned;
  Filler<octomap::ColorOcTree, octomap::ColorOcTreeNode, decltype(set)> filler(tree, cubes, set);
  // OctoMap creates a root only with a voxel; the first voxel of the surface is used.
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
