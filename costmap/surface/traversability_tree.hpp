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

/// A node of the traversability tree: the belief that holds in its cube.
class TraversabilityNode : public octomap::OcTreeDataNode<CellBelief> {
 public:
  TraversabilityNode() : OcTreeDataNode(CellBelief{}) {}
  TraversabilityNode(const TraversabilityNode& other);
  TraversabilityNode& operator=(const TraversabilityNode&) = delete;

  /// Writes the 36 bytes of the payload, little-endian, in the order of CellBelief's fields.
  std::ostream& writeData(std::ostream& stream) const;
  /// Reads them; the stream fails when they are missing or hold a value that no writer wrote.
  std::istream& readData(std::istream& stream);

  const CellBelief& belief() const noexcept { return value; }
  CellBelief& belief() noexcept { return value; }

  /// Frees the array of children once all of them are gone.
  void forgetChildren() noexcept;
};

/// OctoMap tree of type "TraversabilityTree": leaves are the cubes of ground that share one belief.
/// A node whose children are all leaves and equal is pruned into one leaf, also where some children do not
/// exist: it then says "all ground in this cube is so". Where the ground's surface runs inside the cube is
/// the elevation's matter. Not thread-safe while changed.
class TraversabilityTree : public octomap::OcTreeBaseImpl<TraversabilityNode, octomap::AbstractOcTree> {
 public:
  explicit TraversabilityTree(double resolution_m);

  TraversabilityTree* create() const override { return new TraversabilityTree(resolution); }
  std::string getTreeType() const override { return "TraversabilityTree"; }

  /// The belief at a key: that of the leaf whose cube holds it, or null where nothing is known.
  const CellBelief* find(const octomap::OcTreeKey& key) const;
  /// The belief at a key for change; makes the leaf (splitting a pruned cube) when there is none. A depth
  /// below 16 makes a leaf of a cube of 2^(16 - depth) cells a side; the tree must hold nothing finer there.
  CellBelief& at(const octomap::OcTreeKey& key, unsigned depth = 16);

  /// The root, made when there is none.
  TraversabilityNode* makeRoot();

  /// Writes a preamble with the payload's version, then the nodes.
  std::ostream& writeData(std::ostream& stream) const override;
  /// Reads the nodes from a stream without its header; sets failbit on a truncated or foreign one and stays
  /// empty.
  std::istream& readData(std::istream& stream) override;

  bool isNodeCollapsible(const TraversabilityNode* node) const override;
  bool pruneNode(TraversabilityNode* node) override;
  /// Merges equal children bottom-up.
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

/// Writes header and nodes; same tree, same bytes.
void writeTree(const TraversabilityTree& tree, std::ostream& stream);

/// Writes the same bytes node by node, in depth-first order, for a tree that is held nowhere.
class TreeWriter {
 public:
  /// Writes the header; the stream must be able to seek.
  TreeWriter(std::ostream& stream, double resolution_m);
  /// A node; bit i of `children`: child i follows.
  void node(const CellBelief& belief, std::uint8_t children);
  /// Puts the number of nodes into the header.
  void finish();

 private:
  std::ostream& stream_;
  std::streampos size_at_;
  std::size_t nodes_ = 0;
};

/// Reads what writeTree wrote and leaves the stream behind the last node.
/// Throws InputError (where = name) for a stream that is truncated, damaged or another tree type.
TraversabilityTree readTree(std::istream& stream, const std::string& name);

/// A cube of ground that shares one belief, by its lowest keys and its side in cells.
struct TreeLeaf {
  octomap::OcTreeKey low;
  unsigned side = 1;
  CellBelief belief;
};

/// Reads the same stream leaf by leaf, with no tree in memory. Throws as readTree does.
void readLeaves(std::istream& stream, const std::string& name,
                const std::function<void(const TreeLeaf&)>& visit);

}  // namespace talus::costmap
