#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <sstream>
#include <utility>
#include <vector>

#include <talus/common/input_error.hpp>
#include <talus/common/input_file.hpp>
#include <talus/common/memory_budget.hpp>
#include <talus/costmap/surface/octomap_surface.hpp>
#include <talus/costmap/surface/octree_keys.hpp>

namespace talus::costmap {
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
