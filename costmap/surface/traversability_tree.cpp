#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <istream>
#include <iterator>
#include <memory>
#include <ostream>
#include <sstream>

#include <talus/common/common.hpp>
#include <talus/costmap/surface/surface.hpp>
#include <talus/costmap/surface/surface_tree.hpp>

namespace talus::costmap {
namespace {

using octomap::OcTreeKey;

constexpr std::size_t kPayloadBytes = 36;
constexpr std::size_t kVersionAt = 6;  // index of the version in the preamble
using Payload = std::array<char, kPayloadBytes>;
constexpr std::array<char, 8> kPreamble{'T', 'A', 'L', 'U',
                                        'S', 'T', 2,   0};  // last two bytes: version 2, little-endian

template <typename T>
T littleEndian(T value) noexcept {
  if constexpr (std::endian::native == std::endian::big) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    return std::bit_cast<T>(std::array<char, sizeof(T)>{bytes[3], bytes[2], bytes[1], bytes[0]});
  }
  return value;
}

template <typename T>
char* put(char* out, T value) noexcept {
  value = littleEndian(value);
  std::memcpy(out, &value, sizeof value);
  return out + sizeof value;
}

template <typename T>
const char* take(const char* in, T& value) noexcept {
  std::memcpy(&value, in, sizeof value);
  value = littleEndian(value);
  return in + sizeof value;
}

Payload packed(const CellBelief& b) noexcept {
  Payload bytes{};
  char* out = bytes.data();
  for (const float value : {b.pull_mean, b.pull_std, b.sinkage_mean, b.sinkage_std, b.evidence,
                            b.evidence_pull, b.evidence_sinkage})
    out = put(out, value);
  out = put(out, b.updated_s);
  const std::array<std::uint8_t, 4> tail{b.terrain_class, b.category, b.confidence,
                                         static_cast<std::uint8_t>(b.hazards)};
  std::memcpy(out, tail.data(), tail.size());
  return bytes;
}

CellBelief unpacked(const Payload& bytes) noexcept {
  CellBelief b;
  const char* in = bytes.data();
  for (float* value : {&b.pull_mean, &b.pull_std, &b.sinkage_mean, &b.sinkage_std, &b.evidence,
                       &b.evidence_pull, &b.evidence_sinkage})
    in = take(in, *value);
  in = take(in, b.updated_s);
  std::array<std::uint8_t, 4> tail{};
  std::memcpy(tail.data(), in, tail.size());
  b.terrain_class = tail[0];
  b.category = tail[1];
  b.confidence = tail[2];
  b.hazards = static_cast<Hazard>(tail[3]);
  return b;
}

bool plausible(const CellBelief& b) noexcept {
  return b.category <= 3 && b.confidence <= 16 && b.pull_std >= 0 && b.sinkage_std >= 0 && b.evidence >= 0;
}

std::istream& readBelief(std::istream& stream, CellBelief& belief) {
  Payload bytes{};
  if (!stream.read(bytes.data(), kPayloadBytes)) return stream;
  belief = unpacked(bytes);
  if (!plausible(belief)) stream.setstate(std::ios::failbit);
  return stream;
}

using Preamble = std::array<char, kPreamble.size()>;

bool readPreamble(std::istream& stream, Preamble& preamble) {
  return stream.read(preamble.data(), std::ssize(preamble)) && preamble == kPreamble;
}

}  // namespace

TraversabilityNode::TraversabilityNode(const TraversabilityNode& other) : OcTreeDataNode(other.value) {
  if (!other.children) return;
  allocChildren();
  for (int i = 0; i < 8; ++i)
    if (other.children[i])
      children[i] = new TraversabilityNode(*static_cast<TraversabilityNode*>(other.children[i]));
}

std::ostream& TraversabilityNode::writeData(std::ostream& stream) const {
  return stream.write(packed(value).data(), kPayloadBytes);
}

std::istream& TraversabilityNode::readData(std::istream& stream) {
  return readBelief(stream, value);
}

void TraversabilityNode::forgetChildren() noexcept {
  delete[] children;
  children = nullptr;
}

TraversabilityTree::Registration::Registration() {
  auto* prototype = new TraversabilityTree(1.0);
  prototype->clearKeyRays();
  AbstractOcTree::registerTreeType(prototype);
}

const TraversabilityTree::Registration TraversabilityTree::registration_;

TraversabilityTree::TraversabilityTree(double resolution_m) : OcTreeBaseImpl(resolution_m) {
  registration_.touch();
}

const CellBelief* TraversabilityTree::find(const OcTreeKey& key) const {
  const TraversabilityNode* node = root;
  for (unsigned depth = 0; node && nodeHasChildren(node); ++depth) {
    const unsigned child = octomap::computeChildIdx(key, static_cast<int>(kOctreeDepth - 1 - depth));
    node = nodeChildExists(node, child) ? getNodeChild(node, child) : nullptr;
  }
  return node ? &node->belief() : nullptr;
}

TraversabilityNode* TraversabilityTree::makeRoot() {
  if (!root) {
    root = new TraversabilityNode;
    tree_size = 1;
    size_changed = true;
  }
  return root;
}

CellBelief& TraversabilityTree::at(const OcTreeKey& key, unsigned leaf_depth) {
  bool inherits = root != nullptr;
  TraversabilityNode* node = makeRoot();
  for (unsigned depth = 0; depth < leaf_depth; ++depth) {
    if (inherits && !nodeHasChildren(node)) expandNode(node);
    const unsigned child = octomap::computeChildIdx(key, static_cast<int>(kOctreeDepth - 1 - depth));
    inherits = nodeChildExists(node, child);
    node = inherits ? getNodeChild(node, child) : createNodeChild(node, child);
  }
  return node->belief();
}

std::ostream& TraversabilityTree::writeData(std::ostream& stream) const {
  stream.write(kPreamble.data(), kPreamble.size());
  return OcTreeBaseImpl::writeData(stream);
}

std::istream& TraversabilityTree::readData(std::istream& stream) {
  clear();
  Preamble preamble{};
  if (!readPreamble(stream, preamble)) {
    stream.setstate(std::ios::failbit);
    return stream;
  }
  makeRoot();
  if (!readNode(root, stream, 0)) {
    clear();
    stream.setstate(std::ios::failbit);
  }
  return stream;
}

bool TraversabilityTree::readNode(TraversabilityNode* node, std::istream& stream, unsigned depth) {
  char children = 0;
  if (!node->readData(stream) || !stream.get(children)) return false;
  if (depth == kOctreeDepth && children != 0) return false;
  for (unsigned i = 0; i < 8; ++i)
    if ((static_cast<unsigned char>(children) >> i & 1U) &&
        !readNode(createNodeChild(node, i), stream, depth + 1))
      return false;
  return true;
}

bool TraversabilityTree::isNodeCollapsible(const TraversabilityNode* node) const {
  const TraversabilityNode* first = nullptr;
  for (unsigned i = 0; i < 8; ++i) {
    if (!nodeChildExists(node, i)) continue;
    const TraversabilityNode* child = getNodeChild(node, i);
    if (nodeHasChildren(child)) return false;
    if (!first) first = child;
    if (!(child->belief() == first->belief())) return false;
  }
  return first != nullptr;
}

bool TraversabilityTree::pruneNode(TraversabilityNode* node) {
  if (!isNodeCollapsible(node)) return false;
  for (unsigned i = 0; i < 8; ++i) {
    if (!nodeChildExists(node, i)) continue;
    node->copyData(*getNodeChild(node, i));
    deleteNodeChild(node, i);
  }
  node->forgetChildren();
  return true;
}

void TraversabilityTree::pruneBelow(TraversabilityNode* node) {
  for (unsigned i = 0; i < 8; ++i)
    if (nodeChildExists(node, i) && nodeHasChildren(getNodeChild(node, i))) pruneBelow(getNodeChild(node, i));
  pruneNode(node);
}

void TraversabilityTree::prune() {
  if (root && nodeHasChildren(root)) pruneBelow(root);
}

namespace {

// Returns the number of nodes as text of fixed width, so that the field can be overwritten at the end.
std::string sizeField(std::size_t nodes) {
  std::string digits = std::to_string(nodes);
  digits.resize(20, ' ');
  return digits;
}

// Writes the header; returns the position of the number of nodes.
std::streampos writeHeader(std::ostream& stream, double resolution_m, std::size_t nodes) {
  std::array<char, 32> resolution{};
  const auto end = std::to_chars(resolution.begin(), resolution.end(), resolution_m).ptr;
  stream << "# Octomap OcTree file\n# payload and trailer: docs/map_file.md of Talus\nid "
            "TraversabilityTree\nsize ";
  const std::streampos size_at = stream.tellp();
  stream << sizeField(nodes) << "\nres " << std::string(resolution.begin(), end) << "\ndata\n";
  return size_at;
}

}  // namespace

void writeTree(const TraversabilityTree& tree, std::ostream& stream) {
  writeHeader(stream, tree.getResolution(), tree.size());
  if (tree.getRoot()) tree.writeData(stream);
}

TreeWriter::TreeWriter(std::ostream& stream, double resolution_m)
    : stream_(stream), size_at_(writeHeader(stream, resolution_m, 0)) {}

void TreeWriter::node(const CellBelief& belief, std::uint8_t children) {
  if (nodes_++ == 0) stream_.write(kPreamble.data(), kPreamble.size());
  stream_.write(packed(belief).data(), kPayloadBytes);
  stream_.put(static_cast<char>(children));
}

void TreeWriter::finish() {
  const std::streampos end = stream_.tellp();
  stream_.seekp(size_at_) << sizeField(nodes_);
  stream_.seekp(end);
}

namespace {

struct Header {
  std::string id;
  std::size_t size = 0;
  double resolution_m = 0.0;
};

// Reads the text lines up to "data"; returns false if they are not an OctoMap header.
bool readHeader(std::istream& stream, Header& header) {
  std::string line;
  if (!std::getline(stream, line) || line.compare(0, 21, "# Octomap OcTree file") != 0) return false;
  for (int lines = 0; lines < 100 && std::getline(stream, line); ++lines) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "data") return header.resolution_m > 0.0;
    if (word == "id") words >> header.id;
    if (word == "size") words >> header.size;
    if (word == "res") words >> header.resolution_m;
  }
  return false;
}

Header requiredHeader(std::istream& stream, const std::string& name) {
  Header header;
  if (!readHeader(stream, header))
    throw InputError({name, "not an OctoMap .ot file", "write one with talus costmap -o"});
  if (header.id != "TraversabilityTree")
    throw InputError({name, "OctoMap tree of type '" + header.id + "', not TraversabilityTree",
                      "a point-cloud OctoMap is read as a DEM"});
  return header;
}

[[noreturn]] void truncated(const std::string& name) {
  throw InputError({name, "truncated or damaged: its nodes cannot be read", "write the map again"});
}

[[noreturn]] void refused(const Preamble& found, const std::string& name) {
  const bool known = std::equal(found.begin(), found.begin() + kVersionAt, kPreamble.begin());
  if (!known || found[kVersionAt] == kPreamble[kVersionAt]) truncated(name);
  throw InputError({name,
                    "version " + std::to_string(static_cast<unsigned char>(found[kVersionAt])) +
                        " of the format; this program reads " + std::to_string(int{kPreamble[kVersionAt]}),
                    "write the map again with talus costmap, and put the telemetry into it again"});
}

void requireSize(std::size_t nodes, const Header& header, const std::string& name) {
  if (nodes != header.size)
    throw InputError({name,
                      "damaged: " + std::to_string(nodes) + " nodes, the number in its header is " +
                          std::to_string(header.size),
                      "write the map again"});
}

// Traverses the nodes of a stream depth first and counts them.
class LeafWalk {
 public:
  LeafWalk(std::istream& stream, const std::function<void(const TreeLeaf&)>& visit)
      : stream_(stream), visit_(visit) {}

  // Reads the node of a cube and all nodes below; returns false on failure.
  bool below(TreeLeaf cube) {
    ++nodes_;
    char bits = 0;
    if (!readBelief(stream_, cube.belief) || !stream_.get(bits)) return false;
    const auto children = static_cast<unsigned char>(bits);
    if (children == 0) {
      visit_(cube);
      return true;
    }
    if (cube.side == 1) return false;
    const unsigned half = cube.side / 2;
    for (unsigned i = 0; i < 8; ++i) {
      if (!(children >> i & 1U)) continue;
      const auto shifted = [&](unsigned axis) {
        return static_cast<octomap::key_type>(cube.low[axis] + (i >> axis & 1U ? half : 0));
      };
      if (!below({.low = {shifted(0), shifted(1), shifted(2)}, .side = half, .belief = {}})) return false;
    }
    return true;
  }

  std::size_t nodes() const noexcept { return nodes_; }

 private:
  std::istream& stream_;
  const std::function<void(const TreeLeaf&)>& visit_;
  std::size_t nodes_ = 0;
};

}  // namespace

TraversabilityTree readTree(std::istream& stream, const std::string& name) {
  const Header header = requiredHeader(stream, name);
  TraversabilityTree tree(header.resolution_m);
  if (header.size > 0 && !tree.readData(stream)) truncated(name);
  requireSize(tree.size(), header, name);
  return tree;
}

void readLeaves(std::istream& stream, const std::string& name,
                const std::function<void(const TreeLeaf&)>& visit) {
  const Header header = requiredHeader(stream, name);
  LeafWalk walk(stream, visit);
  Preamble preamble{};
  if (header.size > 0 && !readPreamble(stream, preamble)) refused(preamble, name);
  if (header.size > 0 && !walk.below({.low = {0, 0, 0}, .side = 1U << kOctreeDepth, .belief = {}}))
    truncated(name);
  requireSize(walk.nodes(), header, name);
}

}  // namespace talus::costmap
