#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>
#include <type_traits>
#include <utility>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/common/limits.hpp>
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

namespace {

constexpr double kFinest_m = 1e-3, kCoarsest_m = 1e6;
constexpr std::size_t kMostColumns = 400'000'000;

struct PointTreeHeader {
  bool binary = false;  // .bt
  std::string type;
  double resolution_m = 0.0;
};

std::optional<PointTreeHeader> readPointTreeHeader(std::istream& stream) {
  PointTreeHeader header;
  std::string line;
  if (!std::getline(stream, line)) return std::nullopt;
  header.binary = line.rfind("# Octomap OcTree binary file", 0) == 0;
  if (!header.binary && line.rfind("# Octomap OcTree file", 0) != 0) return std::nullopt;
  for (int lines = 0; lines < 100 && std::getline(stream, line); ++lines) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "data") return header;
    if (word == "id") words >> header.type;
    if (word == "res") words >> header.resolution_m;
  }
  return std::nullopt;
}

// An occupied cube, given by its lowest keys and its side.
struct Leaf {
  std::uint32_t x, y, z, side;
};

struct PointCube {
  std::uint32_t x = 0, y = 0, z = 0;
  unsigned depth = 0;

  std::uint32_t side() const { return 1U << (kOctreeDepth - depth); }
  PointCube child(unsigned i) const {
    const std::uint32_t half = side() / 2;
    return {x + (i & 1U ? half : 0), y + (i & 2U ? half : 0), z + (i & 4U ? half : 0), depth + 1};
  }
};

// Reads the nodes of an untrusted file: verifies depth and stream at each node.
class LeafReader {
 public:
  LeafReader(std::istream& stream, const std::string& name, std::size_t color_bytes)
      : stream_(stream), name_(name), color_bytes_(color_bytes) {}

  // .ot: log odds (and colour), then one bit per child.
  void readFull(const PointCube& cube) {
    float log_odds = 0.0F;
    take(&log_odds, sizeof log_odds);
    std::array<char, 3> color{};
    take(color.data(), color_bytes_);
    std::uint8_t children = 0;
    take(&children, 1);
    if (children == 0 && log_odds > 0.0F) leaves_.push_back({cube.x, cube.y, cube.z, cube.side()});
    if (children != 0 && cube.depth >= kOctreeDepth) damaged();
    for (unsigned i = 0; i < 8; ++i)
      if (children >> i & 1U) readFull(cube.child(i));
  }

  // .bt: two bits per child: 0 unknown, 1 free, 2 occupied, 3 inner node.
  void readBinary(const PointCube& cube) {
    if (cube.depth >= kOctreeDepth) damaged();
    std::array<std::uint8_t, 2> bits{};
    take(bits.data(), bits.size());
    const unsigned both = bits[0] | static_cast<unsigned>(bits[1]) << 8;
    for (unsigned i = 0; i < 8; ++i) {
      const PointCube child = cube.child(i);
      if ((both >> (2 * i) & 3U) == kOccupied) leaves_.push_back({child.x, child.y, child.z, child.side()});
    }
    for (unsigned i = 0; i < 8; ++i)
      if ((both >> (2 * i) & 3U) == kInner) readBinary(cube.child(i));
  }

  std::vector<Leaf> take() { return std::move(leaves_); }

 private:
  static constexpr unsigned kOccupied = 2, kInner = 3;

  void take(void* data, std::size_t size) {
    if (!stream_.read(static_cast<char*>(data), static_cast<std::streamsize>(size))) damaged();
  }
  [[noreturn]] void damaged() const {
    throw InputError({name_, "truncated or damaged: its nodes cannot be read", "write the octree again"});
  }

  std::istream& stream_;
  const std::string& name_;
  std::size_t color_bytes_;
  std::vector<Leaf> leaves_;
};

struct Box {
  std::uint32_t x0 = 65536, y0 = 65536, x1 = 0, y1 = 0;
};

Box boxOf(const std::vector<Leaf>& leaves) {
  Box box;
  for (const Leaf& leaf : leaves)
    box = {std::min(box.x0, leaf.x), std::min(box.y0, leaf.y), std::max(box.x1, leaf.x + leaf.side),
           std::max(box.y1, leaf.y + leaf.side)};
  return box;
}

// Occupied voxels of a column from `low` to `high`, both included.
struct Run {
  std::uint16_t low, high;
};

// Runs of all columns; column c has the runs [first[c], first[c + 1]).
struct Columns {
  std::vector<std::uint32_t> first;
  std::vector<Run> runs;
};

template <typename Visit>
void forEachColumn(const Leaf& leaf, const maps::Grid& grid, const Box& box, Visit visit) {
  for (std::uint32_t y = leaf.y - box.y0; y < leaf.y - box.y0 + leaf.side; ++y)
    for (std::uint32_t x = leaf.x - box.x0; x < leaf.x - box.x0 + leaf.side; ++x)
      visit(grid.index({static_cast<int>(x), static_cast<int>(y)}));
}

// Sorts the runs by column with a counting sort, because a cube of side s has s^2 runs, and each column by
// height.
Columns columnsOf(const std::vector<Leaf>& leaves, const maps::Grid& grid, const Box& box) {
  Columns columns{.first = std::vector<std::uint32_t>(grid.size() + 1, 0U), .runs = {}};
  for (const Leaf& leaf : leaves)
    forEachColumn(leaf, grid, box, [&](std::size_t column) { ++columns.first[column + 1]; });
  std::partial_sum(columns.first.begin(), columns.first.end(), columns.first.begin());
  columns.runs.resize(columns.first.back());
  for (const Leaf& leaf : leaves) {
    const Run run{static_cast<std::uint16_t>(leaf.z), static_cast<std::uint16_t>(leaf.z + leaf.side - 1)};
    forEachColumn(leaf, grid, box, [&](std::size_t column) { columns.runs[columns.first[column]++] = run; });
  }
  // The loop advanced each `first` to that of the next column; this shift is undone here.
  std::copy_backward(columns.first.begin(), columns.first.end() - 1, columns.first.end());
  columns.first.front() = 0;
  for (std::size_t c = 0; c + 1 < columns.first.size(); ++c)
    std::sort(columns.runs.begin() + columns.first[c], columns.runs.begin() + columns.first[c + 1],
              [](const Run& a, const Run& b) { return a.low < b.low; });
  return columns;
}

// Returns the height of the highest ground voxel (occupied, with headroom) at or below the ceiling of each
// column; NaN if there is none.
maps::Raster<float> groundOf(const Columns& columns, const maps::Grid& grid, double ceiling_m) {
  const double headroom = std::max(2.0, std::ceil(kHeadroom_m / grid.resolution_m));
  maps::Raster<float> ground(grid, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t c = 0; c + 1 < columns.first.size(); ++c)
    for (std::uint32_t i = columns.first[c]; i < columns.first[c + 1]; ++i) {
      const double high = columns.runs[i].high;
      if (i + 1 < columns.first[c + 1] && columns.runs[i + 1].low <= high + headroom) continue;
      const auto height_m = static_cast<float>((high + 0.5 - kCentreKey) * grid.resolution_m);
      if (static_cast<double>(height_m) <= ceiling_m) ground.values()[c] = height_m;
    }
  return ground;
}

std::vector<Leaf> leavesOf(std::istream& stream, const PointTreeHeader& header, const std::string& name) {
  LeafReader reader(stream, name, header.type == "ColorOcTree" ? 3 : 0);
  if (header.binary)
    reader.readBinary({});
  else
    reader.readFull({});
  return reader.take();
}

}  // namespace

std::optional<std::string> octomapType(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;  // opening a FIFO would block
  std::ifstream stream(path, std::ios::binary);
  std::array<char, 18> start{};
  if (!stream.read(start.data(), start.size()) ||
      std::string(start.data(), start.size()) != "# Octomap OcTree f") {
    stream.clear();
    if (std::string(start.data(), start.size()) != "# Octomap OcTree b") return std::nullopt;
  }
  stream.seekg(0);
  const auto header = readPointTreeHeader(stream);
  return header ? std::optional(header->type) : std::nullopt;
}

maps::ElevationMap octomapGround(std::istream& stream, const std::string& name, double ceiling_m) {
  const auto header = readPointTreeHeader(stream);
  if (!header || !(header->resolution_m > 0.0))
    throw InputError({name, "not an OctoMap file", "give a .bt or .ot of type OcTree or ColorOcTree"});
  if (header->type != "OcTree" && header->type != "ColorOcTree")
    throw InputError(
        {name, "OctoMap tree of type '" + header->type + "'", "give one of type OcTree or ColorOcTree"});
  if (header->resolution_m < kFinest_m || header->resolution_m > kCoarsest_m)
    throw InputError({name,
                      "voxels of " + std::to_string(header->resolution_m) + " m; must be 0.001 m to 1000 km",
                      "write the octree in metres"});
  const std::vector<Leaf> leaves = leavesOf(stream, *header, name);
  if (leaves.empty()) throw InputError({name, "holds no occupied voxel", "check the octree in octovis"});
  const Box box = boxOf(leaves);
  const maps::Grid grid{.width = static_cast<int>(box.x1 - box.x0),
                        .height = static_cast<int>(box.y1 - box.y0),
                        .resolution_m = header->resolution_m,
                        .south_west = {(static_cast<double>(box.x0) - kCentreKey) * header->resolution_m,
                                       (static_cast<double>(box.y0) - kCentreKey) * header->resolution_m}};
  if (grid.size() > kMostColumns)
    throw InputError(
        {name, std::to_string(grid.size()) + " columns, more than 4e8", "crop it or lower its resolution"});
  double runs = 0.0;  // as double, because a leaf may be a cube of side 65536
  for (const Leaf& leaf : leaves) runs += static_cast<double>(leaf.side) * static_cast<double>(leaf.side);
  if (runs > static_cast<double>(kMostColumns))
    throw InputError(
        {name, "its cubes hold more than 4e8 columns of voxels", "crop it or lower its resolution"});
  requireMemory(runs * sizeof(Run) + 8.0 * static_cast<double>(grid.size()), name);
  maps::Raster<float> ground = groundOf(columnsOf(leaves, grid, box), grid, ceiling_m);
  if (maps::validFraction(ground) == 0.0)
    throw InputError({name, "no ground at or below " + std::to_string(ceiling_m) + " m", "increase --below"});
  return {.elevation_m = std::move(ground),
          .georeference = {},
          .source = name,
          .notes = {"top surface of an OctoMap, accurate to half a voxel"}};
}

maps::ElevationMap octomapGround(const std::string& path, double ceiling_m) {
  checkInput(path);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError({path, "cannot be opened", "check the path"});
  return octomapGround(stream, path, ceiling_m);
}

}  // namespace talus::costmap
