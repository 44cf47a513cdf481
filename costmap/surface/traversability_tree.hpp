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

/// Node of the traversability tree: the estimate of its cube.
class TraversabilityNode : public octomap::OcTreeDataNode<CellBelief> {
 public:
  TraversabilityNode() : OcTreeDataNode(CellBelief{}) {}
  TraversabilityNode(const TraversabilityNode& other);
  TraversabilityNode& operator=(const TraversabilityNode&) = delete;

  /// Writes the payload of 36 bytes, little-endian, in the order of CellBelief's fields.
  std::ostream& writeData(std::ostream& stream) const;
  /// Reads the payload; sets failbit if bytes are missing or a value is invalid.
  std::istream& readData(std::istream& stream);

  const CellBelief& belief() const noexcept { return value; }
  CellBelief& belief() noexcept { return value; }

  /// Frees the array of children; all children must have been deleted.
  void forgetChildren() noexcept;
};

/// OctoMap tree of type "TraversabilityTree"; leaves are cubes of ground with one estimate. A node with equal
/// leaves as its only children is pruned, even if some children do not exist. A leaf then applies to all
/// ground in its cube; the elevation determines the position of the ground in the cube. Not thread-safe
/// during changes.
class TraversabilityTree : public octomap::OcTreeBaseImpl<TraversabilityNode, octomap::AbstractOcTree> {
 public:
  explicit TraversabilityTree(double resolution_m);

  TraversabilityTree* create() const override { return new TraversabilityTree(resolution); }
  std::string getTreeType() const override { return "TraversabilityTree"; }

  /// Estimate of the leaf that contains a key; null if there is no leaf.
  const CellBelief* find(const octomap::OcTreeKey& key) const;
  /// Writable estimate at a key; creates the leaf, splitting a pruned cube if needed. A depth below 16
  /// creates a leaf for a cube of 2^(16 - depth) cells per side; the tree must have no finer nodes there.
  CellBelief& at(const octomap::OcTreeKey& key, unsigned depth = 16);

  /// The root; created if absent.
  TraversabilityNode* makeRoot();

  /// Writes a preamble with the version of the payload, then the nodes.
  std::ostream& writeData(std::ostream& stream) const override;
  /// Reads preamble and nodes from a stream without the header; on a truncated or foreign stream, sets
  /// failbit and leaves the tree empty.
  std::istream& readData(std::istream& stream) override;

  bool isNodeCollapsible(const TraversabilityNode* node) const override;
  bool pruneNode(TraversabilityNode* node) override;
  /// Prunes equal children bottom-up.
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

/// Writes header and nodes; equal trees give equal bytes.
void writeTree(const TraversabilityTree& tree, std::ostream& stream);

/// Writes the same bytes node by node in depth-first order, without a tree in memory.
class TreeWriter {
 public:
  /// Writes the header; the stream must be seekable.
  TreeWriter(std::ostream& stream, double resolution_m);
  /// Writes a node; bit i of `children`: child i follows.
  void node(const CellBelief& belief, std::uint8_t children);
  /// Writes the number of nodes into the header.
  void finish();

 private:
  std::ostream& stream_;
  std::streampos size_at_;
  std::size_t nodes_ = 0;
};

/// Reads the output of writeTree() and leaves the stream after the last node. Throws InputError (where =
/// name) for a stream that is truncated, damaged or of another tree type.
TraversabilityTree readTree(std::istream& stream, const std::string& name);

/// A cube of ground with one estimate, given by its lowest keys and its side in cells.
struct TreeLeaf {
  octomap::OcTreeKey low;
  unsigned side = 1;
  CellBelief belief;
};

/// Reads the output of writeTree() leaf by leaf, without a tree in memory. Throws as readTree().
void readLeaves(std::istream& stream, const std::string& name,
                const std::function<void(const TreeLeaf&)>& visit);

}  // namespace talus::costmap
