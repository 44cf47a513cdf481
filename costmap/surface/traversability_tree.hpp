#pragma once

#include <functional>
#include <ios>
#include <iosfwd>
#include <string>

#include <octomap/AbstractOcTree.h>
#include <octomap/OcTreeBaseImpl.h>
#include <octomap/OcTreeDataNode.h>

#include <talus/costmap/surface/cell_belief.hpp>

namespace talus::costmap {

/// Node of the traversability octree, with the estimate of the ground in its cube.
class TraversabilityNode : public octomap::OcTreeDataNode<CellBelief> {
 public:
  TraversabilityNode() : OcTreeDataNode(CellBelief{}) {}
  TraversabilityNode(const TraversabilityNode& other);
  TraversabilityNode& operator=(const TraversabilityNode&) = delete;

  /// Writes the estimate as 36 bytes, little-endian, in the order of CellBelief's fields.
  std::ostream& writeData(std::ostream& stream) const;
  /// Reads the estimate; sets failbit if bytes are missing or a value is invalid.
  std::istream& readData(std::istream& stream);

  const CellBelief& belief() const noexcept { return value; }
  CellBelief& belief() noexcept { return value; }

  /// Frees the array of child pointers; all children must have been deleted.
  void forgetChildren() noexcept;
};

/// OctoMap octree of type "TraversabilityTree". A leaf is a cube of ground with one estimate, which applies
/// to all ground in the cube; the elevation map gives the position of the ground inside the cube. A node
/// whose existing children are equal leaves is pruned (becomes a leaf itself), even if some children do not
/// exist. Not thread-safe during changes.
class TraversabilityTree : public octomap::OcTreeBaseImpl<TraversabilityNode, octomap::AbstractOcTree> {
 public:
  /// Makes an empty tree whose smallest cubes have sides of resolution_m [m].
  explicit TraversabilityTree(double resolution_m);

  TraversabilityTree* create() const override { return new TraversabilityTree(resolution); }
  std::string getTreeType() const override { return "TraversabilityTree"; }

  /// Returns the estimate of the leaf that contains a key; null if there is no leaf.
  const CellBelief* find(const octomap::OcTreeKey& key) const;
  /// Returns the estimate at a key for modification; creates the leaf, and splits a pruned cube if needed. A
  /// depth below 16 creates a leaf for a cube of 2^(16 - depth) cells per side; the tree must have no finer
  /// nodes there.
  CellBelief& at(const octomap::OcTreeKey& key, unsigned depth = 16);

  /// Returns the root node; creates it if absent.
  TraversabilityNode* makeRoot();

  /// Writes a preamble with the version of the node format, then the nodes.
  std::ostream& writeData(std::ostream& stream) const override;
  /// Reads the preamble and the nodes from a stream behind the file header. Sets failbit and leaves the tree
  /// empty if the stream is truncated or of another format.
  std::istream& readData(std::istream& stream) override;

  bool isNodeCollapsible(const TraversabilityNode* node) const override;
  bool pruneNode(TraversabilityNode* node) override;
  /// Prunes all nodes with equal children, from the leaves upwards.
  void prune() override;

 private:
  bool readNode(TraversabilityNode* node, std::istream& stream, unsigned depth);
  void pruneBelow(TraversabilityNode* node);

  struct Registration {
    Registration();
    void touch() const noexcept {}
  };
  static const Registration registration_;
};

/// Writes the file header and the nodes of a tree; equal trees give equal bytes.
void writeTree(const TraversabilityTree& tree, std::ostream& stream);

/// Writes the bytes of writeTree() node by node in depth-first order, without a tree in memory.
class TreeWriter {
 public:
  /// Writes the file header; the stream must be seekable.
  TreeWriter(std::ostream& stream, double resolution_m);
  /// Writes a node; bit i of `children` is 1 if the child i follows.
  void node(const CellBelief& belief, std::uint8_t children);
  /// Writes the number of nodes into the header. Must be called after the last node.
  void finish();

 private:
  std::ostream& stream_;
  std::streampos size_at_;
  std::size_t nodes_ = 0;
};

/// Returns the tree that writeTree() wrote to a stream, and leaves the stream after the last node. Throws
/// InputError for a stream that is truncated, damaged or of another tree type; the error names the stream
/// `name`.
TraversabilityTree readTree(std::istream& stream, const std::string& name);

/// A leaf of the tree: a cube of ground with one estimate, given by its lowest keys and its side length in
/// cells.
struct TreeLeaf {
  octomap::OcTreeKey low;
  unsigned side = 1;
  CellBelief belief;
};

/// Reads the output of writeTree() and calls `visit` for each leaf, without a tree in memory. Throws
/// InputError in the cases of readTree().
void readLeaves(std::istream& stream, const std::string& name,
                const std::function<void(const TreeLeaf&)>& visit);

}  // namespace talus::costmap
